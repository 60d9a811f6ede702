// Files of a tiny recording, written by hand: 4 x 3 pixels, a baseline of 0.1 m.
#pragma once

#include <string>

#include "support/temp_folder.h"

namespace accrete::hal {

// A grey map of one value.
inline std::string pgm(int width, int height, char value = 100) {
  return "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" +
         std::string(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), value);
}

inline std::string matrix(const std::string& name, int rows, int cols, const std::string& data) {
  return name + ": !!opencv-matrix\n   rows: " + std::to_string(rows) + "\n   cols: " + std::to_string(cols) +
         "\n   dt: d\n   data: [ " + data + " ]\n";
}

// The pieces of stereo.yml, each of which a test may replace.
struct StereoYml {
  std::string head = "%YAML:1.0\n---\nimage_width: 4\nimage_height: 3\nunits: m\n";
  std::string M1 = "10., 0., 1.5, 0., 11., 1., 0., 0., 1.";
  std::string D1 = "-0.1, 0.01, 0.001, -0.002, 0.003";
  std::string M2 = "12., 0., 1.6, 0., 13., 1.1, 0., 0., 1.";
  std::string D2 = "0., 0., 0., 0., 0.";
  std::string R = "1., 0., 0., 0., 1., 0., 0., 0., 1.";
  std::string T = "-0.1, 0., 0.";

  [[nodiscard]] std::string text() const {
    return head + matrix("M1", 3, 3, M1) + matrix("D1", 1, 5, D1) + matrix("M2", 3, 3, M2) + matrix("D2", 1, 5, D2) +
           matrix("R", 3, 3, R) + matrix("T", 3, 1, T);
  }
};

// left/ right/ 0 .. n-1 .pgm, stereo.yml, object_poses.txt that moves by 1 mm a frame at 30 Hz.
inline void write_plain(const test::TempFolder& folder, int n = 3) {
  std::string poses = "# TUM: t tx ty tz qx qy qz qw\n";
  for (int i = 0; i < n; ++i) {
    const std::string name = std::to_string(i) + ".pgm";
    folder.write("left/" + name, pgm(4, 3, static_cast<char>('a' + i)));
    folder.write("right/" + name, pgm(4, 3, static_cast<char>('A' + i)));
    poses += std::to_string(i / 30.0) + " " + std::to_string(0.001 * i) + " 0 1 0 0 0 1\n";
  }
  folder.write("stereo.yml", StereoYml{}.text());
  folder.write("object_poses.txt", poses);
}

}  // namespace accrete::hal
