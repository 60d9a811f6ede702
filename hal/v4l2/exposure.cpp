#include "v4l2/exposure.h"

#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>

namespace accrete::hal::v4l2 {
namespace {

struct Control {
  std::uint32_t id;
  const char* name;
};

// Where automatics end. The order is that of the calls: a value can be set once its automatic is off.
struct Switch {
  std::uint32_t id;
  std::int32_t off;
};
constexpr Switch kSwitches[] = {
    {V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL},
    {V4L2_CID_AUTOGAIN, 0},
    {V4L2_CID_AUTO_WHITE_BALANCE, 0},
};

// What belongs together, for the sentence about what a camera lacks.
struct Group {
  const char* name;
  Control values[2];
};
constexpr Group kGroups[] = {
    {"exposure time", {{V4L2_CID_EXPOSURE_ABSOLUTE, "exposure_time_absolute"}, {V4L2_CID_EXPOSURE, "exposure"}}},
    {"gain", {{V4L2_CID_GAIN, "gain"}, {V4L2_CID_ANALOGUE_GAIN, "analogue_gain"}}},
    {"white balance",
     {{V4L2_CID_WHITE_BALANCE_TEMPERATURE, "white_balance_temperature"}, {V4L2_CID_RED_BALANCE, "red_balance"}}},
    {"", {{V4L2_CID_BLUE_BALANCE, "blue_balance"}, {0, nullptr}}},  // the other half of red_balance
};

bool has(Kernel& kernel, int fd, std::uint32_t id) {
  v4l2_queryctrl raw{};
  raw.id = id;
  return ioctl_retrying(kernel, fd, VIDIOC_QUERYCTRL, &raw) == 0 &&
         (raw.flags & (V4L2_CTRL_FLAG_DISABLED | V4L2_CTRL_FLAG_READ_ONLY)) == 0;
}

bool get(Kernel& kernel, int fd, std::uint32_t id, std::int32_t& value) {
  v4l2_control raw{};
  raw.id = id;
  if (ioctl_retrying(kernel, fd, VIDIOC_G_CTRL, &raw) < 0) return false;
  value = raw.value;
  return true;
}

bool set(Kernel& kernel, int fd, std::uint32_t id, std::int32_t value) {
  v4l2_control raw{};
  raw.id = id;
  raw.value = value;
  return ioctl_retrying(kernel, fd, VIDIOC_S_CTRL, &raw) == 0;
}

// Once: a stream may be started more than once.
void say(LiveDeviceStatistics& device, const std::string& notice) {
  if (std::find(device.notices.begin(), device.notices.end(), notice) == device.notices.end())
    device.notices.push_back(notice);
}

}  // namespace

void ExposureLock::make_automatic(int fd) {
  // UVC cameras know aperture priority (automatic time, fixed aperture), others full automatic.
  if (has(kernel_, fd, V4L2_CID_EXPOSURE_AUTO) &&
      !set(kernel_, fd, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY))
    set(kernel_, fd, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_AUTO);
  for (const std::uint32_t id : {V4L2_CID_AUTOGAIN, V4L2_CID_AUTO_WHITE_BALANCE})
    if (has(kernel_, fd, id)) set(kernel_, fd, id, 1);
  // Otherwise a camera halves its rate in the dark.
  if (has(kernel_, fd, V4L2_CID_EXPOSURE_AUTO_PRIORITY)) set(kernel_, fd, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);
}

void ExposureLock::lock(int left_fd, LiveDeviceStatistics& left, int right_fd, LiveDeviceStatistics& right) {
  values_.clear();
  for (const Group& group : kGroups) {
    bool any = false;
    for (const Control& control : group.values) {
      if (any || control.name == nullptr || !has(kernel_, left_fd, control.id)) continue;
      std::int32_t value = 0;
      if (!get(kernel_, left_fd, control.id, value)) continue;
      values_.push_back({control.name, control.id, value});
      any = true;
    }
    if (!any && group.name[0] != '\0')
      say(left, std::string("it has no control of its ") + group.name + ": the camera may change it");
  }
  locked_ = true;
  apply(left_fd, left);
  if (right_fd >= 0) apply(right_fd, right);
}

void ExposureLock::apply(int fd, LiveDeviceStatistics& device) {
  device.locked.clear();
  if (!locked_) return;
  for (const Switch& automatic : kSwitches)
    if (has(kernel_, fd, automatic.id) && !set(kernel_, fd, automatic.id, automatic.off))
      say(device, "an automatic of it cannot be switched off: " + error_text(errno));
  for (const Value& wanted : values_) {
    const std::string name = wanted.name;
    if (!has(kernel_, fd, wanted.id)) {
      say(device, "it has no control " + name + ", which the other camera has");
      continue;
    }
    std::int32_t got = wanted.value;
    if (!set(kernel_, fd, wanted.id, wanted.value)) {
      say(device, name + " cannot be set: " + error_text(errno));
    } else if (get(kernel_, fd, wanted.id, got) && got != wanted.value) {
      say(device, name + " is " + std::to_string(got) + " instead of " + std::to_string(wanted.value));
      device.locked.push_back(name + " " + std::to_string(got));
    } else {
      device.locked.push_back(name + " " + std::to_string(wanted.value));
    }
  }
}

void ExposureLock::forget() {
  values_.clear();
  locked_ = false;
}

}  // namespace accrete::hal::v4l2
