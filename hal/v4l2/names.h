// Which node a person means, and by what it is found again after it was unplugged.
#pragma once

#include <string>
#include <vector>

#include "accrete/hal/v4l2.h"
#include "v4l2/kernel.h"

namespace accrete::hal::v4l2 {

inline constexpr const char* kFolderById = "/dev/v4l/by-id/";
inline constexpr const char* kFolderByPath = "/dev/v4l/by-path/";

// Nodes of /dev that are named video..., in the order of their numbers.
[[nodiscard]] std::vector<std::string> video_nodes(Kernel& kernel);

// The link in `folder` that leads to `node`, empty: none.
[[nodiscard]] std::string link_to(Kernel& kernel, const std::string& folder, const std::string& node);

// The node of LiveOptions::left or right. Status: kNotFound, kInvalidArgument (a card or a bus that several have).
[[nodiscard]] Outcome find_node(Kernel& kernel, const std::string& name, std::string& node);

// What QUERYCAP says.
struct Capability {
  std::string card, driver, bus;
  bool captures = false;  // video, by streaming
  bool multiplanar = false;
};
// False and errno.
[[nodiscard]] bool query_capability(Kernel& kernel, int fd, Capability& capability);

// A device that was opened once. Found again by its link; without one by its node, if card and bus are the same.
struct Identity {
  std::string link;  // path, empty: none
  std::string node;  // at first
  std::string card, bus;
};
// `same_model`: the other camera has the same card. Then the port tells them apart, since cameras without a serial
// number share one name in by-id.
[[nodiscard]] Identity identify(Kernel& kernel, const std::string& node, const Capability& capability, bool same_model);
// Where it is now, empty: not there.
[[nodiscard]] std::string find_again(Kernel& kernel, const Identity& identity);

}  // namespace accrete::hal::v4l2
