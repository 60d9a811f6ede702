// The first frames of the synthetic scene as a plain folder on disk, for tests that damage it.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "accrete/hal/synthetic.h"
#include "support/temp_folder.h"

namespace accrete::cli {

inline std::string ppm(const ImageView& image) {
  std::string out = "P6\n" + std::to_string(image.width_px) + " " + std::to_string(image.height_px) + "\n255\n";
  for (int y = 0; y < image.height_px; ++y)
    out.append(reinterpret_cast<const char*>(image.row(y)), static_cast<std::size_t>(image.width_px) * 3);
  return out;
}

// left/ right/ NN.ppm, stereo.yml, object_poses.txt and times.txt at 30 Hz, in the folder `name`.
inline void write_scene(const test::TempFolder& folder, const std::string& name, int frames) {
  hal::SyntheticOptions options;
  std::unique_ptr<hal::StereoSource> stereo;
  std::unique_ptr<hal::MotionSource> motion;
  ASSERT_TRUE(hal::open_synthetic("box-plain", options, stereo, motion).ok());
  if (stereo->state() == hal::StereoSource::SourceState::kClosed) {
    ASSERT_TRUE(stereo->configure().ok());
  }
  ASSERT_TRUE(stereo->start().ok());
  std::string poses, times;
  for (int i = 0; i < frames; ++i) {
    StereoFrame frame;
    Motion m;
    ASSERT_TRUE(stereo->acquire(0, frame).ok());
    ASSERT_TRUE(motion->at(frame.t_left, m).ok());
    char number[16], line[300], time[32];
    std::snprintf(number, sizeof number, "%02d", i);
    std::snprintf(time, sizeof time, "%.9f", 1e-9 * static_cast<double>(frame.t_left.ns));
    const Quaternion& q = m.T_l_m.rotation;
    const Vec3& t = m.T_l_m.translation;
    std::snprintf(line, sizeof line, "%s %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n", time, t[0], t[1], t[2], q.x, q.y,
                  q.z, q.w);
    poses += line;
    times += std::string(time) + "\n";
    folder.write(name + "/left/" + number + ".ppm", ppm(frame.left));
    folder.write(name + "/right/" + number + ".ppm", ppm(frame.right));
    stereo->release();
  }
  const StereoRig& rig = stereo->rig();
  const auto matrix = [](const char* key, int rows, int columns, const std::string& data) {
    return std::string(key) + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
           "\n   cols: " + std::to_string(columns) + "\n   dt: d\n   data: [ " + data + " ]\n";
  };
  const auto camera = [](const Camera& c) {
    return std::to_string(c.fx_px) + ", 0., " + std::to_string(c.cx_px) + ", 0., " + std::to_string(c.fy_px) + ", " +
           std::to_string(c.cy_px) + ", 0., 0., 1.";
  };
  folder.write(name + "/stereo.yml",
               "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\nunits: m\n" +
                   matrix("M1", 3, 3, camera(rig.left)) + matrix("D1", 1, 5, "0., 0., 0., 0., 0.") +
                   matrix("M2", 3, 3, camera(rig.right)) + matrix("D2", 1, 5, "0., 0., 0., 0., 0.") +
                   matrix("R", 3, 3, "1., 0., 0., 0., 1., 0., 0., 0., 1.") +
                   matrix("T", 3, 1, std::to_string(rig.T_r_l.translation[0]) + ", 0., 0."));
  folder.write(name + "/object_poses.txt", poses);
  folder.write(name + "/times.txt", times);
}

}  // namespace accrete::cli
