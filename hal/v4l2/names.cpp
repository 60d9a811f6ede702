#include "v4l2/names.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "text/sentence.h"

namespace accrete::hal::v4l2 {
namespace {

constexpr std::string_view kVideo = "video";

bool all_digits(std::string_view text) {
  return !text.empty() && text.size() <= 4 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// A field of the kernel's with a fixed length, and nothing that a terminal would obey.
template <std::size_t n>
std::string text_of(const __u8 (&field)[n]) {
  std::string text;
  for (std::size_t i = 0; i < n && field[i] != 0; ++i)
    text += field[i] >= ' ' && field[i] <= '~' ? static_cast<char>(field[i]) : '?';
  return text;
}

std::string there_is(Kernel& kernel) {
  const std::vector<std::string> nodes = video_nodes(kernel);
  if (nodes.empty()) return "there is no /dev/video*: is a camera plugged in, and its driver loaded?";
  std::string text = "there is";
  for (const std::string& node : nodes) text += (text.size() > 8 ? ", " : " ") + node;
  return text + "; accrete devices shows their names";
}

}  // namespace

std::vector<std::string> video_nodes(Kernel& kernel) {
  std::vector<std::string> nodes;
  for (const std::string& name : kernel.list("/dev"))
    if (name.starts_with(kVideo) && all_digits(std::string_view(name).substr(kVideo.size())))
      nodes.push_back("/dev/" + name);
  std::sort(nodes.begin(), nodes.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  return nodes;
}

std::string link_to(Kernel& kernel, const std::string& folder, const std::string& node) {
  std::vector<std::string> names = kernel.list(folder);
  std::sort(names.begin(), names.end());
  for (const std::string& name : names)
    if (kernel.resolve(folder + name) == node) return folder + name;
  return {};
}

bool query_capability(Kernel& kernel, int fd, Capability& capability) {
  v4l2_capability raw{};
  if (ioctl_retrying(kernel, fd, VIDIOC_QUERYCAP, &raw) < 0) return false;
  const std::uint32_t bits = (raw.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? raw.device_caps : raw.capabilities;
  capability.card = text_of(raw.card);
  capability.driver = text_of(raw.driver);
  capability.bus = text_of(raw.bus_info);
  capability.multiplanar = (bits & V4L2_CAP_VIDEO_CAPTURE) == 0 && (bits & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0;
  capability.captures =
      (bits & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) != 0 && (bits & V4L2_CAP_STREAMING) != 0;
  return true;
}

Outcome find_node(Kernel& kernel, const std::string& name, std::string& node) {
  if (name.empty()) return {Status::kInvalidArgument, "no camera was named; " + there_is(kernel)};
  std::vector<std::string> paths;
  if (name.front() == '/') {
    paths = {name};
  } else if (all_digits(name)) {
    paths = {"/dev/video" + name};
  } else if (name.find('/') == std::string::npos) {
    paths = {"/dev/" + name, kFolderById + name, kFolderByPath + name};
  }
  for (const std::string& path : paths)
    if (node = kernel.resolve(path); !node.empty()) return {};
  std::vector<std::string> found;
  for (const std::string& candidate : video_nodes(kernel)) {
    const int fd = open_retrying(kernel, candidate.c_str());
    if (fd < 0) continue;
    Capability capability;
    if (query_capability(kernel, fd, capability) && capability.captures &&
        (capability.card == name || capability.bus == name))
      found.push_back(candidate);
    kernel.close(fd);
  }
  if (found.size() == 1) {
    node = found[0];
    return {};
  }
  if (found.size() > 1)
    return {Status::kInvalidArgument, "several cameras are called " + in_quotes(name) + ": " + found[0] + " and " +
                                          found[1] + "; name one by its node or by its link in /dev/v4l/by-path"};
  return {Status::kNotFound, "there is no camera " + in_quotes(name) + "; " + there_is(kernel)};
}

Identity identify(Kernel& kernel, const std::string& node, const Capability& capability, bool same_model) {
  Identity identity{{}, node, capability.card, capability.bus};
  if (!same_model) identity.link = link_to(kernel, kFolderById, node);
  if (identity.link.empty()) identity.link = link_to(kernel, kFolderByPath, node);
  return identity;
}

std::string find_again(Kernel& kernel, const Identity& identity) {
  return kernel.resolve(identity.link.empty() ? identity.node : identity.link);
}

}  // namespace accrete::hal::v4l2
