// The two instances of the kernel's vivid, and the faults that they inject.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>

namespace accrete::vm {

// The kernel's drivers/media/test-drivers/vivid/vivid-ctrls.c; documented in admin-guide/media/vivid.rst by name.
enum class Vivid : std::uint32_t {
  kPattern = 0x00f0f000,
  kText = 0x00f0f001,             // 2: none
  kTimestampSource = 0x00f0f018,  // 0 end of frame, 1 start of exposure
  kSequenceWrap = 0x00f0f026,     // starts at 2^32 - 128
  kTimestampWrap = 0x00f0f027,    // 1: tv_sec near its end
  kDropPercent = 0x00f0f040,
  kDisconnect = 0x00f0f041,
  kBufferError = 0x00f0f042,
  kReqbufsError = 0x00f0f043,
  kQbufError = 0x00f0f044,
  kStreamonError = 0x00f0f045,
  kFatalError = 0x00f0f046,
};

inline constexpr const char* kDevices[] = {"/dev/video0", "/dev/video1"};

// Through a descriptor of its own, as another program would.
inline void set(int device, Vivid control, int value) {
  const int fd = open(kDevices[device], O_RDWR | O_CLOEXEC);
  v4l2_control c{static_cast<std::uint32_t>(control), value};
  EXPECT_EQ(ioctl(fd, VIDIOC_S_CTRL, &c), 0) << kDevices[device] << " " << std::hex << c.id << " errno " << errno;
  close(fd);
}

}  // namespace accrete::vm
