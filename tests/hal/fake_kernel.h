// A kernel with fake cameras and a clock that nobody waits for. Any call can be made to fail, and every file and
// mapping is accounted for. A program that calls for ever is stopped.
#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <set>

#include "fake_camera.h"
#include "v4l2/kernel.h"

namespace accrete::hal {

class FakeKernel final : public v4l2::Kernel {
 public:
  std::map<std::string, std::shared_ptr<FakeCamera>> nodes;  // "/dev/video0"
  std::map<std::string, std::string> links;                  // "/dev/v4l/by-id/left" -> "/dev/video0"
  std::multimap<std::int64_t, std::function<void()>> events;
  std::int64_t now = 1'000'000'000;

  // Which calls fail: from the number fail_at on, fail_count of them.
  long calls = 0, fail_at = -1, fail_count = 1;
  int fail_errno = 0;
  std::string failed;  // the first that did
  long max_calls = 200'000;

  std::map<int, std::shared_ptr<FakeCamera>> files;
  std::map<void*, std::pair<std::size_t, std::shared_ptr<FakeCamera>>> mappings;

  std::shared_ptr<FakeCamera> add(const std::string& node, std::uint8_t id) {
    auto camera = std::make_shared<FakeCamera>();
    camera->id = id;
    camera->bus = "usb-" + std::to_string(id);
    nodes[node] = camera;
    return camera;
  }
  void unplug(const std::string& node) {
    const auto found = nodes.find(node);
    if (found == nodes.end()) return;
    found->second->present = false;
    nodes.erase(found);
    for (auto link = links.begin(); link != links.end();) link = link->second == node ? links.erase(link) : ++link;
  }
  // Nothing open, mapped or running.
  [[nodiscard]] testing::AssertionResult clean() const {
    if (!files.empty()) return testing::AssertionFailure() << files.size() << " files are open";
    if (!mappings.empty()) return testing::AssertionFailure() << mappings.size() << " mappings are left";
    for (const auto& [node, camera] : nodes)
      if (camera->streaming || !camera->buffers.empty()) return testing::AssertionFailure() << node << " still runs";
    return testing::AssertionSuccess();
  }

  int open(const char* path, int /*flags*/) override {
    if (injected("open")) return -1;
    const auto found = nodes.find(path);
    if (found == nodes.end()) return fail(ENOENT);
    files[next_file_] = found->second;
    return next_file_++;
  }
  int close(int fd) override {
    const bool error = injected("close");  // and yet it is closed, as Linux does
    const auto found = files.find(fd);
    if (found == files.end()) return fail(EBADF);
    if (found->second->owner == fd) found->second->free_buffers();
    files.erase(found);
    return error ? fail(fail_errno) : 0;
  }
  void* mmap(std::size_t length, int fd, std::int64_t offset) override {
    if (injected("mmap")) return MAP_FAILED;
    FakeCamera* c = camera_of(fd);
    if (c == nullptr) return MAP_FAILED;
    const auto buffer = static_cast<std::size_t>(offset / 4096 / 4),
               plane = static_cast<std::size_t>(offset / 4096 % 4);
    if (buffer >= c->buffers.size() || plane >= c->buffers[buffer].planes.size()) return fail(EINVAL), MAP_FAILED;
    void* address = c->buffers[buffer].planes[plane].data();
    EXPECT_EQ(length, c->buffers[buffer].planes[plane].size());
    EXPECT_TRUE(mappings.emplace(address, std::pair{length, files[fd]}).second) << "mapped twice";
    ++c->mappings;
    return address;
  }
  int munmap(void* address, std::size_t length) override {
    if (injected("munmap")) return -1;
    const auto found = mappings.find(address);
    if (found == mappings.end() || found->second.first != length) {
      ADD_FAILURE() << "something else was unmapped";
      return fail(EINVAL);
    }
    --found->second.second->mappings;
    mappings.erase(found);
    return 0;
  }
  std::int64_t now_ns() override {
    count_call();
    return now;
  }
  int poll(pollfd* fds, unsigned count, int timeout_ms) override {
    if (injected("poll")) return -1;
    const std::int64_t deadline = now + std::int64_t{timeout_ms} * 1'000'000;
    for (;;) {
      advance();
      int ready = 0;
      std::int64_t next = deadline;
      for (unsigned i = 0; i < count; ++i) {
        fds[i].revents = revents_of(fds[i].fd, next);
        ready += fds[i].revents != 0 ? 1 : 0;
      }
      if (ready > 0 || now >= deadline) return ready;
      if (!events.empty()) next = std::min(next, std::max(events.begin()->first, now + 1));
      now = next;
    }
  }
  int ioctl(int fd, unsigned long request, void* argument) override;

  std::vector<std::string> list(const std::string& folder) override {
    std::set<std::string> names;
    const std::string prefix = folder.back() == '/' ? folder : folder + "/";
    const auto add_name = [&](const std::string& path) {
      if (path.starts_with(prefix))
        names.insert(path.substr(prefix.size(), path.find('/', prefix.size()) - prefix.size()));
    };
    for (const auto& [node, camera] : nodes) add_name(node);
    for (const auto& [link, node] : links) add_name(link);
    return {names.begin(), names.end()};
  }
  std::string resolve(const std::string& path) override {
    const auto link = links.find(path);
    const std::string& node = link == links.end() ? path : link->second;
    return nodes.contains(node) ? node : std::string();
  }

 private:
  static int fail(int error) {
    errno = error;
    return -1;
  }
  void count_call() {
    if (++unguarded_ > max_calls) throw std::runtime_error("it calls for ever");
  }
  bool injected(const char* name) {
    count_call();
    const long call = calls++;
    if (fail_at < 0 || call < fail_at || call >= fail_at + fail_count) return false;
    if (fail_count > 1 && std::strcmp(name, "munmap") == 0) return false;  // for ever: nobody could help that
    if (failed.empty()) failed = name;
    errno = fail_errno;
    return true;
  }
  FakeCamera* camera_of(int fd) {
    const auto found = files.find(fd);
    if (found == files.end()) return fail(EBADF), nullptr;
    if (!found->second->present) return fail(ENODEV), nullptr;
    return found->second.get();
  }
  void advance() {
    while (!events.empty() && events.begin()->first <= now) {
      const auto event = events.begin()->second;
      events.erase(events.begin());
      event();
    }
    for (auto& [fd, camera] : files) camera->advance(now);
  }
  short revents_of(int fd, std::int64_t& next) const {
    const auto found = files.find(fd);
    if (found == files.end()) return POLLNVAL;
    const FakeCamera& c = *found->second;
    if (!c.present) return POLLERR | POLLHUP;
    if (!c.streaming || c.broken) return POLLERR;
    if (!c.done.empty()) return POLLIN;
    next = std::min(next, std::max(c.due_ns(c.number) + c.delivered_after_ns, now + 1));
    return 0;
  }
  int controls(FakeCamera& c, unsigned long request, void* argument);
  int streaming(FakeCamera& c, int fd, unsigned long request, void* argument);
  int buffer(FakeCamera& c, unsigned long request, v4l2_buffer& b);
  static void set_format(FakeCamera& c, v4l2_format& f);

  int next_file_ = 100;
  long unguarded_ = 0;
};

inline int FakeKernel::controls(FakeCamera& c, unsigned long request, void* argument) {
  const std::uint32_t id = *static_cast<std::uint32_t*>(argument);  // the first member of all three
  const auto found = c.controls.find(id);
  if (found == c.controls.end()) return fail(EINVAL);
  FakeControl& control = found->second;
  if (request == VIDIOC_QUERYCTRL) {
    auto& q = *static_cast<v4l2_queryctrl*>(argument);
    q.minimum = control.min;
    q.maximum = control.max;
    q.flags = control.flags;
    return 0;
  }
  auto& value = *static_cast<v4l2_control*>(argument);
  if (request == VIDIOC_G_CTRL) {
    value.value = control.value;
    return 0;
  }
  if (id == V4L2_CID_EXPOSURE_AUTO && value.value == V4L2_EXPOSURE_AUTO) return fail(EINVAL);  // as UVC cameras
  control.value = std::clamp(value.value, control.min, control.max);
  return 0;
}

inline void FakeKernel::set_format(FakeCamera& c, v4l2_format& f) {
  const std::uint32_t width = c.multiplanar ? f.fmt.pix_mp.width : f.fmt.pix.width;
  const std::uint32_t height = c.multiplanar ? f.fmt.pix_mp.height : f.fmt.pix.height;
  const std::uint32_t wanted = c.multiplanar ? f.fmt.pix_mp.pixelformat : f.fmt.pix.pixelformat;
  // As vivid: another format or size, and no error.
  c.fourcc = c.sizes.contains(wanted) ? wanted : c.sizes.begin()->first;
  const auto& sizes = c.sizes[c.fourcc];
  const std::pair size{width, height};
  std::tie(c.width, c.height) = std::find(sizes.begin(), sizes.end(), size) != sizes.end() ? size : sizes.front();
}

inline int FakeKernel::buffer(FakeCamera& c, unsigned long request, v4l2_buffer& b) {
  if (request == VIDIOC_DQBUF) {
    if (c.broken) return fail(EIO);
    if (!c.streaming) return fail(EINVAL);
    if (c.done.empty()) return fail(EAGAIN);
    b.index = c.done.front();
    c.done.pop_front();
    c.buffers[b.index].queued = false;
  }
  if (b.index >= c.buffers.size()) return fail(EINVAL);
  FakeCamera::Buffer& own = c.buffers[b.index];
  if (request == VIDIOC_QBUF) {
    if (own.queued) return fail(EINVAL);
    own.queued = true;
    c.queued.push_back(b.index);
    return 0;
  }
  b.sequence = own.sequence;
  b.flags = own.flags;
  b.timestamp.tv_sec = static_cast<time_t>(own.t_ns / 1'000'000'000);
  b.timestamp.tv_usec = static_cast<suseconds_t>(own.t_ns % 1'000'000'000 / 1000);
  if (c.multiplanar && b.length < own.planes.size()) return fail(EINVAL);
  for (std::uint32_t p = 0; p < own.planes.size(); ++p) {
    const auto length = static_cast<std::uint32_t>(own.planes[p].size());
    const std::uint32_t offset = (b.index * 4 + p) * 4096;
    if (c.multiplanar) {
      b.m.planes[p].length = length;
      b.m.planes[p].m.mem_offset = offset;
      b.m.planes[p].bytesused = static_cast<std::uint32_t>(own.used[p]);
    } else {
      b.length = length;
      b.m.offset = offset;
      b.bytesused = static_cast<std::uint32_t>(own.used[p]);
    }
  }
  return 0;
}

inline int FakeKernel::streaming(FakeCamera& c, int fd, unsigned long request, void* argument) {
  if (c.owner >= 0 && c.owner != fd) return fail(EBUSY);  // another program
  switch (request) {
    case VIDIOC_REQBUFS: {
      auto& r = *static_cast<v4l2_requestbuffers*>(argument);
      if (c.mappings > 0 || (c.streaming && r.count > 0)) return fail(EBUSY);
      c.free_buffers();
      if (r.count == 0) return 0;
      c.owner = fd;
      FakeCamera::Buffer b;
      for (std::uint32_t p = 0; p < c.plane_count(); ++p) b.planes.emplace_back(c.plane_bytes(p));
      b.used.resize(b.planes.size());
      c.buffers.assign(r.count, b);
      return 0;
    }
    case VIDIOC_STREAMON:
      if (c.buffers.empty()) return fail(EINVAL);
      c.streaming = true;
      c.started_ns = now;
      c.number = c.lost = 0;
      return 0;
    case VIDIOC_STREAMOFF:
      c.end_stream();
      return 0;
    default:
      return buffer(c, request, *static_cast<v4l2_buffer*>(argument));
  }
}

inline int FakeKernel::ioctl(int fd, unsigned long request, void* argument) {
  if (injected(("ioctl " + std::to_string(request & 0xff)).c_str())) return -1;
  advance();
  FakeCamera* const found = camera_of(fd);
  if (found == nullptr) return -1;
  FakeCamera& c = *found;
  const std::uint32_t type = c.multiplanar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
  switch (request) {
    case VIDIOC_QUERYCAP: {
      auto& cap = *static_cast<v4l2_capability*>(argument);
      std::strncpy(reinterpret_cast<char*>(cap.card), c.card.c_str(), sizeof cap.card - 1);
      std::strncpy(reinterpret_cast<char*>(cap.driver), c.driver.c_str(), sizeof cap.driver - 1);
      std::strncpy(reinterpret_cast<char*>(cap.bus_info), c.bus.c_str(), sizeof cap.bus_info - 1);
      // As UVC: `capabilities` are those of all nodes together.
      cap.capabilities = V4L2_CAP_DEVICE_CAPS | V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
      cap.device_caps = V4L2_CAP_STREAMING | (c.metadata      ? V4L2_CAP_META_CAPTURE
                                              : c.multiplanar ? V4L2_CAP_VIDEO_CAPTURE_MPLANE
                                                              : V4L2_CAP_VIDEO_CAPTURE);
      return 0;
    }
    case VIDIOC_ENUM_FMT: {
      auto& f = *static_cast<v4l2_fmtdesc*>(argument);
      if (f.type != type || f.index >= c.sizes.size()) return fail(EINVAL);
      f.pixelformat = std::next(c.sizes.begin(), f.index)->first;
      return 0;
    }
    case VIDIOC_ENUM_FRAMESIZES: {
      auto& s = *static_cast<v4l2_frmsizeenum*>(argument);
      if (!c.sizes.contains(s.pixel_format) || s.index >= c.sizes[s.pixel_format].size()) return fail(EINVAL);
      s.type = V4L2_FRMSIZE_TYPE_DISCRETE;
      std::tie(s.discrete.width, s.discrete.height) = c.sizes[s.pixel_format][s.index];
      return 0;
    }
    case VIDIOC_ENUM_FRAMEINTERVALS: {
      auto& i = *static_cast<v4l2_frmivalenum*>(argument);
      if (i.index > 0) return fail(EINVAL);
      i.type = V4L2_FRMIVAL_TYPE_DISCRETE;
      i.discrete = {1, c.rate_hz};
      return 0;
    }
    case VIDIOC_G_FMT:
    case VIDIOC_S_FMT: {
      auto& f = *static_cast<v4l2_format*>(argument);
      if (f.type != type) return fail(EINVAL);
      if (request == VIDIOC_S_FMT && c.owner >= 0) return fail(EBUSY);
      if (request == VIDIOC_S_FMT) set_format(c, f);
      const auto answer = [&c](auto& pix) {
        pix.width = c.width;
        pix.height = c.height;
        pix.pixelformat = c.fourcc;
        pix.field = c.field;
        pix.colorspace = V4L2_COLORSPACE_SRGB;
        pix.quantization = static_cast<std::uint8_t>(c.quantization);
      };
      if (c.multiplanar) {
        answer(f.fmt.pix_mp);
        f.fmt.pix_mp.num_planes = static_cast<std::uint8_t>(c.plane_count());
        for (std::uint32_t p = 0; p < c.plane_count(); ++p)
          f.fmt.pix_mp.plane_fmt[p] = {c.plane_bytes(p), c.stride(), {}};
      } else {
        answer(f.fmt.pix);
        f.fmt.pix.bytesperline = c.stride();
      }
      return 0;
    }
    case VIDIOC_G_PARM:
    case VIDIOC_S_PARM:
      static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {1, c.rate_hz};
      return 0;
    case VIDIOC_QUERYCTRL:
    case VIDIOC_G_CTRL:
    case VIDIOC_S_CTRL:
      return controls(c, request, argument);
    case VIDIOC_REQBUFS:
    case VIDIOC_QUERYBUF:
    case VIDIOC_QBUF:
    case VIDIOC_DQBUF:
    case VIDIOC_STREAMON:
    case VIDIOC_STREAMOFF:
      return streaming(c, fd, request, argument);
    default:
      return fail(ENOTTY);
  }
}

}  // namespace accrete::hal
