// The only file that includes libcamera: 0.0.3 (Debian 12) and newer. Controls go by their names, which are older and
// steadier than the types behind them.
#include "libcamera/cameras.h"

#include <libcamera/libcamera.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>

#include "libcamera/deep_call.h"
#include "libcamera/mapped_planes.h"
#include "libcamera/one_at_a_time.h"
#include "libcamera/value_text.h"
#include "text/sentence.h"

namespace accrete::hal::libcam {
namespace {

namespace lc = ::libcamera;

std::string error_text(int negative_errno) { return std::strerror(-negative_errno); }

// ---- Values of controls as text.

template <class T>
std::optional<lc::ControlValue> numbers(const std::string& text) {
  const std::vector<T> values = parse_values<T>(text);
  if (values.empty()) return std::nullopt;
  if (values.size() == 1) return lc::ControlValue(values[0]);
  return lc::ControlValue(lc::Span<const T>(values));
}

// Nothing: the text is no value of this type.
std::optional<lc::ControlValue> to_value(lc::ControlType type, const std::string& text) {
  if (type == lc::ControlTypeInteger32) return numbers<std::int32_t>(text);
  if (type == lc::ControlTypeInteger64) return numbers<std::int64_t>(text);
  if (type == lc::ControlTypeFloat) return numbers<float>(text);
  if (type != lc::ControlTypeBool || (text != "true" && text != "false")) return std::nullopt;
  return lc::ControlValue(text == "true");
}

template <class T>
std::string numbers_text(const lc::ControlValue& value) {
  if (!value.isArray()) {
    const T one = value.get<T>();
    return values_text(std::span<const T>(&one, 1));
  }
  const auto all = value.get<lc::Span<const T>>();
  return values_text(std::span<const T>(all.data(), all.size()));
}

std::string to_text(const lc::ControlValue& value) {
  if (value.type() == lc::ControlTypeInteger32) return numbers_text<std::int32_t>(value);
  if (value.type() == lc::ControlTypeInteger64) return numbers_text<std::int64_t>(value);
  if (value.type() == lc::ControlTypeFloat) return numbers_text<float>(value);
  return value.toString();
}

const lc::ControlId* find_control(const lc::ControlInfoMap& controls, const std::string& name) {
  for (const auto& [id, info] : controls)
    if (id->name() == name) return id;
  return nullptr;
}

// ---- One camera.

lc::PixelFormat pixel_format(const KnownFormat& format) { return lc::PixelFormat::fromString(format.name); }

std::string sizes_text(const lc::StreamFormats& formats, lc::PixelFormat format) {
  std::string text;
  for (const lc::Size& size : formats.sizes(format))
    text += (text.empty() ? "" : ", ") + size_text(size.width, size.height);
  return text;
}

struct Slot {
  std::unique_ptr<lc::Request> request;
  lc::FrameBuffer* buffer = nullptr;
  MappedPlanes planes;
  std::vector<std::size_t> used;  // bytes of the last image, of each plane
};

class RealDevice final : public Device {
 public:
  RealDevice(std::shared_ptr<lc::CameraManager> manager, std::shared_ptr<lc::Camera> camera)
      : manager_(std::move(manager)), camera_(std::move(camera)) {}
  ~RealDevice() override {
    stop();
    release_buffers();
    deep_call([this] { return camera_->release(); });
  }

  std::vector<std::string> formats() const override;
  Outcome configure(const KnownFormat& format, camera::Size size, int buffers, Negotiated& negotiated) override;
  bool has_control(const std::string& name) const override {
    return find_control(camera_->controls(), name) != nullptr;
  }
  Outcome check(const LibcameraControl& control) const override;
  void set(const std::vector<LibcameraControl>& controls) override { next_ = controls; }
  std::vector<LibcameraControl> reported(const std::vector<std::string>& names) const override;
  Outcome start(camera::Eye eye, Mailbox& mailbox) override;
  void stop() override;
  void give_back(int slot) override;
  camera::RawImage raw(int slot) const override;

 private:
  [[nodiscard]] static bool map(Slot& slot);  // false and errno
  void release_buffers();
  void completed(lc::Request* request);
  void gone();
  [[nodiscard]] int queue(Slot& slot);

  std::shared_ptr<lc::CameraManager> manager_;  // outlives the camera
  std::shared_ptr<lc::Camera> camera_;
  std::unique_ptr<lc::CameraConfiguration> configuration_;
  std::unique_ptr<lc::FrameBufferAllocator> allocator_;
  std::vector<Slot> slots_;
  const KnownFormat* known_ = nullptr;
  camera::Eye eye_ = camera::Eye::kLeft;
  Mailbox* mailbox_ = nullptr;          // null: not started
  std::vector<LibcameraControl> next_;  // for the next request
  mutable std::mutex reported_mutex_;
  std::map<std::string, std::string> reported_;  // with the last image
};

std::vector<std::string> RealDevice::formats() const {
  std::vector<std::string> names;
  if (const auto configuration = camera_->generateConfiguration({lc::StreamRole::VideoRecording}))
    for (const lc::PixelFormat& format : configuration->at(0).formats().pixelformats())
      names.push_back(format.toString());
  return names;
}

Outcome RealDevice::configure(const KnownFormat& format, camera::Size size, int buffers, Negotiated& negotiated) {
  release_buffers();
  configuration_ = camera_->generateConfiguration({lc::StreamRole::VideoRecording});
  if (!configuration_ || configuration_->empty()) return {Status::kUnsupported, "it has no stream of images"};
  lc::StreamConfiguration& stream = configuration_->at(0);
  const std::string offered = sizes_text(stream.formats(), pixel_format(format));
  stream.pixelFormat = pixel_format(format);
  if (size.width_px > 0) stream.size = {static_cast<unsigned>(size.width_px), static_cast<unsigned>(size.height_px)};
  stream.bufferCount = static_cast<unsigned>(buffers);
  if (configuration_->validate() == lc::CameraConfiguration::Invalid || stream.pixelFormat != pixel_format(format) ||
      (size.width_px > 0 && (stream.size.width != static_cast<unsigned>(size.width_px) ||
                             stream.size.height != static_cast<unsigned>(size.height_px))))
    return {Status::kUnsupported, "it does not deliver " + std::string(format.name) +
                                      (size.width_px > 0 ? " of " + size_text(size.width_px, size.height_px) : "") +
                                      (offered.empty() ? "" : "; it has " + offered)};
  if (const int error = deep_call([this] { return camera_->configure(configuration_.get()); }); error < 0)
    return {Status::kUnavailable, "it cannot be configured: " + error_text(error)};
  allocator_ = std::make_unique<lc::FrameBufferAllocator>(camera_);
  if (const int count = deep_call([&] { return allocator_->allocate(stream.stream()); }); count < 3) {
    release_buffers();
    return {Status::kUnavailable, "it has no memory for three images"};
  }
  for (const auto& buffer : allocator_->buffers(stream.stream())) {
    Slot slot;
    slot.buffer = buffer.get();
    slot.request = camera_->createRequest(slots_.size());
    Outcome o;
    if (!slot.request || slot.request->addBuffer(stream.stream(), slot.buffer) != 0)
      o = {Status::kUnavailable, "it takes no request"};
    else if (!map(slot))
      o = {Status::kUnavailable, "its buffers cannot be mapped: " + error_text(-errno)};
    slots_.push_back(std::move(slot));
    if (!o.ok()) return release_buffers(), o;
  }
  known_ = &format;
  negotiated = {&format,
                {static_cast<int>(stream.size.width), static_cast<int>(stream.size.height)},
                static_cast<int>(slots_.size())};
  return {};
}

bool RealDevice::map(Slot& slot) {
  std::vector<FilePlane> planes;
  for (const lc::FrameBuffer::Plane& plane : slot.buffer->planes())
    planes.push_back(
        {plane.fd.get(), plane.offset == lc::FrameBuffer::Plane::kInvalidOffset ? 0 : plane.offset, plane.length});
  slot.used.resize(planes.size());
  return slot.planes.map(planes);
}

// Requests before buffers, buffers before the allocator. Requests of a camera that was pulled out never complete: they
// are not waited for.
void RealDevice::release_buffers() {
  slots_.clear();
  allocator_.reset();
}

Outcome RealDevice::check(const LibcameraControl& control) const {
  const lc::ControlId* id = find_control(camera_->controls(), control.name);
  if (id == nullptr) {
    std::string all;
    for (const auto& [each, info] : camera_->controls()) all += (all.empty() ? "" : ", ") + each->name();
    return {Status::kInvalidArgument,
            "it has no control " + in_quotes(control.name) + "; it has " + (all.empty() ? "none" : all)};
  }
  const lc::ControlInfo& info = camera_->controls().at(id);
  const std::optional<lc::ControlValue> value = to_value(id->type(), control.value);
  const bool outside = value && !value->isArray() && id->type() == lc::ControlTypeInteger32 &&
                       info.min().type() == lc::ControlTypeInteger32 &&
                       (value->get<std::int32_t>() < info.min().get<std::int32_t>() ||
                        value->get<std::int32_t>() > info.max().get<std::int32_t>());
  if (value && !outside) return {};
  return {Status::kInvalidArgument,
          in_quotes(control.value) + " is no value of the control " + control.name + ": it takes " + info.toString()};
}

std::vector<LibcameraControl> RealDevice::reported(const std::vector<std::string>& names) const {
  const std::lock_guard lock(reported_mutex_);
  std::vector<LibcameraControl> result;
  for (const std::string& name : names)
    if (const auto found = reported_.find(name); found != reported_.end()) result.push_back({name, found->second});
  return result;
}

int RealDevice::queue(Slot& slot) {
  for (const LibcameraControl& control : next_)
    if (const lc::ControlId* id = find_control(camera_->controls(), control.name))
      if (const auto value = to_value(id->type(), control.value)) slot.request->controls().set(id->id(), *value);
  next_.clear();
  return camera_->queueRequest(slot.request.get());
}

Outcome RealDevice::start(camera::Eye eye, Mailbox& mailbox) {
  eye_ = eye;
  mailbox_ = &mailbox;
  camera_->requestCompleted.connect(this, &RealDevice::completed);
  camera_->disconnected.connect(this, &RealDevice::gone);
  if (const int error = deep_call([this] { return camera_->start(); }); error < 0) {
    stop();
    return {Status::kUnavailable, "it cannot be started: " + error_text(error)};
  }
  for (Slot& slot : slots_) {
    slot.request->reuse(lc::Request::ReuseBuffers);
    if (const int error = queue(slot); error < 0) {
      stop();
      return {Status::kUnavailable, "it takes no request: " + error_text(error)};
    }
  }
  return {};
}

void RealDevice::stop() {
  if (mailbox_ == nullptr) return;
  // What it still has comes back before this returns, unless it was pulled out.
  deep_call([this] { return camera_->stop(); });
  camera_->requestCompleted.disconnect(this);
  camera_->disconnected.disconnect(this);
  mailbox_ = nullptr;
}

void RealDevice::give_back(int slot) {
  Slot& s = slots_[static_cast<std::size_t>(slot)];
  s.planes.end_reading();
  s.request->reuse(lc::Request::ReuseBuffers);
  if (mailbox_ != nullptr && queue(s) < 0) gone();
}

camera::RawImage RealDevice::raw(int slot) const {
  const Slot& s = slots_[static_cast<std::size_t>(slot)];
  const lc::StreamConfiguration& stream = configuration_->at(0);
  camera::RawImage image{
      known_->raw, static_cast<int>(stream.size.width), static_cast<int>(stream.size.height), {}, {}};
  if (stream.colorSpace) {
    image.colour.bt709 = stream.colorSpace->ycbcrEncoding == lc::ColorSpace::YcbcrEncoding::Rec709;
    image.colour.full_range = stream.colorSpace->range == lc::ColorSpace::Range::Full;
  }
  const auto bytes = [&s](std::size_t plane) {
    return s.planes[plane].first(std::min(s.used[plane], s.planes[plane].size()));
  };
  if (s.planes.count() == 1) {
    image.planes = camera::split_planes(image.format, image.width_px, image.height_px, stream.stride, bytes(0));
    return image;
  }
  // Planes of their own: of half the luma's stride where Cb and Cr are apart.
  for (std::size_t i = 0; i < std::min(s.planes.count(), image.planes.size()); ++i)
    image.planes[i] = {bytes(i), i > 0 && known_->raw == camera::RawFormat::kYu12 ? stream.stride / 2 : stream.stride};
  return image;
}

// In libcamera's thread.
void RealDevice::completed(lc::Request* request) {
  if (request->status() == lc::Request::RequestCancelled) return;  // stop()
  Letter letter;
  letter.eye = eye_;
  letter.slot = static_cast<int>(request->cookie());
  Slot& slot = slots_[static_cast<std::size_t>(letter.slot)];
  const lc::FrameMetadata& metadata = slot.buffer->metadata();
  for (std::size_t i = 0; i < slot.used.size(); ++i)
    slot.used[i] = i < metadata.planes().size() ? metadata.planes()[i].bytesused : 0;
  letter.what = metadata.status == lc::FrameMetadata::FrameSuccess ? Letter::What::kImage : Letter::What::kDamaged;
  letter.sequence = metadata.sequence;
  const auto exposed = request->metadata().get(lc::controls::SensorTimestamp);
  letter.of_exposure = static_cast<bool>(exposed);
  letter.t_ns = exposed ? *exposed : static_cast<std::int64_t>(metadata.timestamp);
  {
    const std::lock_guard lock(reported_mutex_);
    for (const auto& [id, value] : request->metadata())
      if (const auto known = lc::controls::controls.find(id); known != lc::controls::controls.end())
        reported_[known->second->name()] = to_text(value);
  }
  slot.planes.begin_reading();
  mailbox_->push(letter);
}

void RealDevice::gone() {
  Letter letter;
  letter.what = Letter::What::kGone;
  letter.eye = eye_;
  mailbox_->push(letter);
}

// ---- All of them.

// libcamera ends a process that makes a second manager. Never destroyed: a source may live longer than main().
std::shared_ptr<lc::CameraManager> shared_manager(int& error) {
  static auto& one = *new OneAtATime<lc::CameraManager>;
  error = 0;
  return one.get([&error] {
    auto manager = std::make_unique<lc::CameraManager>();
    error = manager->start();
    if (error < 0) manager.reset();
    return manager;
  });
}

std::string model_of(const lc::Camera& camera) {
  const auto model = camera.properties().get(lc::properties::Model);
  return model ? std::string(*model) : std::string();
}

class RealCameras final : public Cameras {
 public:
  Outcome start() override {
    int error = 0;
    if (!manager_) manager_ = shared_manager(error);
    if (manager_) return {};
    return {Status::kUnavailable, "libcamera cannot be started: " + error_text(error)};
  }
  void stop() override { manager_.reset(); }

  std::vector<LibcameraCamera> list() const override {
    std::vector<LibcameraCamera> all;
    for (const std::shared_ptr<lc::Camera>& camera : manager_->cameras()) {
      LibcameraCamera found{camera->id(), model_of(*camera), {}, {}, {}};
      const auto configuration = camera->generateConfiguration({lc::StreamRole::VideoRecording});
      if (!configuration || configuration->empty()) {
        found.problem = "it has no stream of images";
      } else {
        const lc::StreamFormats& formats = configuration->at(0).formats();
        for (const lc::PixelFormat& format : formats.pixelformats()) {
          const KnownFormat* known = find_format(format.toString());
          LibcameraFormat one{format.toString(), known != nullptr && understood(*known), {}};
          for (const lc::Size& size : formats.sizes(format))
            one.sizes.push_back(std::to_string(size.width) + "x" + std::to_string(size.height));
          found.formats.push_back(std::move(one));
        }
      }
      for (const auto& [id, info] : camera->controls()) found.controls.push_back(id->name() + " " + info.toString());
      std::sort(found.controls.begin(), found.controls.end());
      all.push_back(std::move(found));
    }
    return all;
  }

  Outcome open(const std::string& id, std::unique_ptr<Device>& device) override {
    const std::shared_ptr<lc::Camera> camera = manager_->get(id);
    if (!camera) return {Status::kNotFound, "it is not there"};
    if (const int error = deep_call([&camera] { return camera->acquire(); }); error < 0)
      return {Status::kUnavailable, "it cannot be had (" + error_text(error) + "): does another program use it?"};
    device = std::make_unique<RealDevice>(manager_, camera);
    return {};
  }

 private:
  std::shared_ptr<lc::CameraManager> manager_;
};

}  // namespace

std::unique_ptr<Cameras> make_cameras() { return std::make_unique<RealCameras>(); }
std::string version() { return lc::CameraManager::version(); }

}  // namespace accrete::hal::libcam
