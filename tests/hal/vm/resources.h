// What this process holds of the kernel's cameras, by the kernel's own account.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "accrete/hal/libcamera.h"

namespace accrete::vm {

struct Resources {
  int descriptors = 0;    // of anything
  int video_devices = 0;  // descriptors of cameras
  int video_maps = 0;     // mapped buffers of cameras
};

inline Resources resources() {
  Resources r;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    ++r.descriptors;
    if (std::filesystem::read_symlink(entry, error).string().starts_with("/dev/video")) ++r.video_devices;
  }
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);)
    if (line.find("/dev/video") != std::string::npos) ++r.video_maps;
  return r;
}

// A test after which nothing may be left.
class LeavesNothing : public testing::Test {
 protected:
  // libcamera keeps one descriptor for a thread that has used it once, as long as the thread lives.
  static void SetUpTestSuite() { (void)hal::list_libcamera_cameras(); }
  void TearDown() override {
    const Resources now = resources();
    EXPECT_EQ(now.descriptors, before_.descriptors);
    EXPECT_EQ(now.video_devices, 0);
    EXPECT_EQ(now.video_maps, 0);
  }

 private:
  Resources before_ = resources();
};

}  // namespace accrete::vm
