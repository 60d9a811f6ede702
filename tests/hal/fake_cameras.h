// libcamera's cameras by hand: a test pushes the letters and sees what a device was told. What libcamera really does is
// seen in the virtual machine (vm/camera_faults.cpp).
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "libcamera/cameras.h"

namespace accrete::hal::libcam {

struct FakeCamera {
  std::string id, model;
  std::vector<std::string> formats = {"YUYV", "R8"};
  std::vector<std::string> controls = {"AeEnable", "ExposureTime", "AnalogueGain", "FrameDurationLimits"};
  std::map<std::string, std::string> reported = {{"ExposureTime", "5000"}, {"AnalogueGain", "2"}};
  bool plugged = true;
  bool starts = true;

  // What became of it.
  int open = 0;  // devices that exist
  std::vector<LibcameraControl> told{};
  std::vector<int> given_back{};
  Mailbox* mailbox = nullptr;
  camera::Eye eye = camera::Eye::kLeft;
  int next_slot = 0;
  std::uint32_t sequence = 0;

  void deliver(std::int64_t t_ns, Letter::What what = Letter::What::kImage) {
    Letter letter;
    letter.what = what;
    letter.eye = eye;
    letter.slot = next_slot++ % 4;
    letter.t_ns = t_ns;
    letter.of_exposure = true;
    letter.sequence = sequence++;
    mailbox->push(letter);
  }
  void pull_out() {
    plugged = false;
    deliver(0, Letter::What::kGone);
  }
};

class FakeDevice final : public Device {
 public:
  explicit FakeDevice(FakeCamera& camera) : camera_(camera) { ++camera_.open; }
  ~FakeDevice() override {
    stop();
    --camera_.open;
  }

  std::vector<std::string> formats() const override { return camera_.formats; }
  Outcome configure(const KnownFormat& format, camera::Size size, int buffers, Negotiated& negotiated) override {
    if (size.width_px > 64) return {Status::kUnsupported, "it does not deliver that"};
    known_ = &format;
    size_ = size.width_px > 0 ? size : camera::Size{16, 8};
    negotiated = {&format, size_, buffers};
    bytes_.assign(std::size_t{2} * static_cast<std::size_t>(size_.width_px * size_.height_px), 128);
    return {};
  }
  bool has_control(const std::string& name) const override {
    return std::find(camera_.controls.begin(), camera_.controls.end(), name) != camera_.controls.end();
  }
  Outcome check(const LibcameraControl& control) const override {
    if (has_control(control.name)) return {};
    return {Status::kInvalidArgument, "it has no control '" + control.name + "'"};
  }
  void set(const std::vector<LibcameraControl>& controls) override {
    camera_.told.insert(camera_.told.end(), controls.begin(), controls.end());
  }
  std::vector<LibcameraControl> reported(const std::vector<std::string>& names) const override {
    std::vector<LibcameraControl> result;
    for (const std::string& name : names)
      if (const auto found = camera_.reported.find(name); found != camera_.reported.end())
        result.push_back({name, found->second});
    return result;
  }
  Outcome start(camera::Eye eye, Mailbox& mailbox) override {
    if (!camera_.starts) return {Status::kUnavailable, "it cannot be started"};
    camera_.eye = eye;
    camera_.mailbox = &mailbox;
    camera_.sequence = 0;
    return {};
  }
  void stop() override { camera_.mailbox = nullptr; }
  void give_back(int slot) override { camera_.given_back.push_back(slot); }
  camera::RawImage raw(int /*slot*/) const override {
    camera::RawImage image{known_->raw, size_.width_px, size_.height_px, {}, {}};
    const std::size_t stride =
        static_cast<std::size_t>(size_.width_px) * (known_->raw == camera::RawFormat::kGrey ? 1 : 2);
    image.planes = camera::split_planes(image.format, image.width_px, image.height_px, stride, bytes_);
    return image;
  }

 private:
  FakeCamera& camera_;
  const KnownFormat* known_ = nullptr;
  camera::Size size_;
  std::vector<std::uint8_t> bytes_;
};

class FakeCameras final : public Cameras {
 public:
  explicit FakeCameras(std::vector<FakeCamera>& all, int& running) : all_(all), running_(running) {}
  ~FakeCameras() override { stop(); }

  Outcome start() override {
    if (!started_) ++running_;
    started_ = true;
    seen_.clear();
    for (FakeCamera& camera : all_)
      if (camera.plugged) seen_.push_back(&camera);
    return {};
  }
  void stop() override {
    if (started_) --running_;
    started_ = false;
  }
  std::vector<LibcameraCamera> list() const override {
    std::vector<LibcameraCamera> result;
    for (const FakeCamera* camera : seen_) result.push_back({camera->id, camera->model, {}, {}, {}});
    return result;
  }
  Outcome open(const std::string& id, std::unique_ptr<Device>& device) override {
    for (FakeCamera* camera : seen_)
      if (camera->id == id) {
        device = std::make_unique<FakeDevice>(*camera);
        return {};
      }
    return {Status::kNotFound, "it is not there"};
  }

 private:
  std::vector<FakeCamera>& all_;
  std::vector<FakeCamera*> seen_;
  int& running_;
  bool started_ = false;
};

}  // namespace accrete::hal::libcam
