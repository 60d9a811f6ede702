#include "v4l2/open.h"

#include <cerrno>
#include <exception>

#include "v4l2/enumerate.h"
#include "v4l2/names.h"
#include "v4l2/source.h"

namespace accrete::hal {
namespace v4l2 {

Outcome open(Kernel& kernel, const LiveOptions& options, std::unique_ptr<LiveSource>& source) {
  source.reset();
  auto live = std::make_unique<Source>(kernel, options);
  if (Outcome o = live->configure(); !o.ok()) return o;
  source = std::move(live);
  return {};
}

std::vector<V4l2Device> list(Kernel& kernel) {
  std::vector<V4l2Device> devices;
  for (const std::string& node : video_nodes(kernel)) {
    V4l2Device device;
    device.node = node;
    const int fd = open_retrying(kernel, node.c_str());
    Capability capability;
    if (fd < 0 || !query_capability(kernel, fd, capability)) {
      device.problem = error_text(errno);
    } else {
      device.card = capability.card;
      device.driver = capability.driver;
      device.bus = capability.bus;
      if (capability.captures) device.formats = enumerate_formats(kernel, fd, capability.multiplanar, true);
      device.likely_layout = likely_layout(device.formats);
    }
    if (fd >= 0) kernel.close(fd);
    if (device.problem.empty() && !capability.captures) continue;
    std::string link = link_to(kernel, kFolderById, node);
    if (link.empty()) link = link_to(kernel, kFolderByPath, node);
    device.id = link.substr(link.rfind('/') + 1);
    devices.push_back(std::move(device));
  }
  return devices;
}

}  // namespace v4l2

Outcome open_v4l2(const LiveOptions& options, std::unique_ptr<LiveSource>& source) {
  try {
    return v4l2::open(v4l2::linux_kernel(), options, source);
  } catch (const std::exception& e) {  // out of memory, or a file system that plays tricks
    source.reset();
    return {Status::kUnavailable, std::string("the cameras cannot be opened: ") + e.what()};
  }
}

std::vector<V4l2Device> list_v4l2_devices() { return v4l2::list(v4l2::linux_kernel()); }

}  // namespace accrete::hal
