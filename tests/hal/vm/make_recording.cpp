// make_recording FOLDER FRAMES grey|colour: a plain recording of the synthetic scene at half its size, every image with
// its number in its pixels. Grey images are PGM, colour ones JPEG.
#include <turbojpeg.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "accrete/hal/synthetic.h"
#include "frame_number.h"

namespace accrete::vm {
namespace {

namespace fs = std::filesystem;

// Half the image's size on both axes: means of 2 x 2 pixels.
std::vector<std::uint8_t> half(const ImageView& image, int to_channels) {
  std::vector<std::uint8_t> small;
  for (int y = 0; y + 1 < image.height_px; y += 2)
    for (int x = 0; x + 1 < image.width_px; x += 2) {
      int grey = 0;
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int i = 0; i < 4; ++i) sum += image.row(y + i / 2)[(x + i % 2) * 3 + c];
        grey += sum;
        if (to_channels == 3) small.push_back(static_cast<std::uint8_t>((sum + 2) / 4));
      }
      if (to_channels == 1) small.push_back(static_cast<std::uint8_t>((grey + 6) / 12));
    }
  return small;
}

// Grey images as PGM, colour as JPEG.
void write_image(const fs::path& path, const ImageView& image, FrameNumber number, int to_channels) {
  std::vector<std::uint8_t> pixels = half(image, to_channels);
  const int width = image.width_px / 2, height = image.height_px / 2;
  stamp(number, pixels.data(), width, to_channels);
  std::ofstream file(path, std::ios::binary);
  if (to_channels == 1) {
    file << "P5\n" << width << " " << height << "\n255\n";
    file.write(reinterpret_cast<const char*>(pixels.data()), static_cast<std::streamsize>(pixels.size()));
  } else {
    const tjhandle jpeg = tjInitCompress();
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    if (tjCompress2(jpeg, pixels.data(), width, 0, height, TJPF_RGB, &bytes, &size, TJSAMP_444, 95, 0) != 0)
      throw std::runtime_error(tjGetErrorStr2(jpeg));
    file.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    tjFree(bytes);
    tjDestroy(jpeg);
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

void write_matrix(std::ostream& to, const std::string& name, int rows, int columns, const std::vector<double>& values) {
  to << name << ": !!opencv-matrix\n   rows: " << rows << "\n   cols: " << columns << "\n   dt: d\n   data: [ ";
  for (std::size_t i = 0; i < values.size(); ++i) to << (i > 0 ? ", " : "") << values[i];
  to << " ]\n";
}

// Pixel centres lie at integers: half of x is (x + 0.5) / 2 - 0.5.
std::vector<double> half_matrix(const Camera& c) {
  return {c.fx_px / 2, 0, (c.cx_px + 0.5) / 2 - 0.5, 0, c.fy_px / 2, (c.cy_px + 0.5) / 2 - 0.5, 0, 0, 1};
}

void write_calibration(const fs::path& path, const StereoRig& rig) {
  std::ofstream file(path);
  file << std::setprecision(17) << std::showpoint << "%YAML:1.0\n---\nimage_width: " << rig.left.width_px / 2
       << "\nimage_height: " << rig.left.height_px / 2 << "\nunits: m\n";
  const Mat3 R = to_matrix(rig.T_r_l.rotation);
  const Vec3 T = rig.T_r_l.translation;
  write_matrix(file, "M1", 3, 3, half_matrix(rig.left));
  write_matrix(file, "D1", 1, 5, std::vector<double>(5));
  write_matrix(file, "M2", 3, 3, half_matrix(rig.right));
  write_matrix(file, "D2", 1, 5, std::vector<double>(5));
  write_matrix(file, "R", 3, 3, {R.begin(), R.end()});
  write_matrix(file, "T", 3, 1, {T.begin(), T.end()});
}

void make(const fs::path& folder, int frames, int to_channels) {
  hal::SyntheticOptions options;
  options.frames = frames;
  options.degrees_per_frame = 3;
  std::unique_ptr<hal::StereoSource> source;
  std::unique_ptr<hal::MotionSource> motion;
  const auto check = [](const hal::Outcome& outcome) {
    if (!outcome.ok()) throw std::runtime_error(outcome.message);
  };
  check(hal::open_synthetic("box-plain", options, source, motion));
  if (source->state() == hal::StereoSource::SourceState::kClosed) check(source->configure());
  check(source->start());
  fs::create_directories(folder / "left");
  fs::create_directories(folder / "right");
  write_calibration(folder / "stereo.yml", source->rig());
  std::ofstream times(folder / "times.txt"), poses(folder / "object_poses.txt");
  times << std::fixed << std::setprecision(9);
  poses << std::fixed << std::setprecision(9);
  for (int i = 0; i < frames; ++i) {
    StereoFrame frame;
    Motion at;
    check(source->acquire(0, frame));
    check(motion->at(frame.t_left, at));
    const std::string digits = std::to_string(i);
    const std::string name = std::string(4 - digits.size(), '0') + digits + (to_channels == 1 ? ".pgm" : ".jpg");
    write_image(folder / "left" / name, frame.left, {i, false}, to_channels);
    write_image(folder / "right" / name, frame.right, {i, true}, to_channels);
    const double t = 1e-9 * static_cast<double>(frame.t_left.ns);
    const auto& [q, p] = at.T_l_m;
    times << t << "\n";
    poses << t << " " << p[0] << " " << p[1] << " " << p[2] << " " << q.x << " " << q.y << " " << q.z << " " << q.w
          << "\n";
    source->release();
  }
}

}  // namespace
}  // namespace accrete::vm

int main(int argc, char** argv) {
  try {
    if (argc != 4) throw std::runtime_error("usage: make_recording FOLDER FRAMES grey|colour");
    accrete::vm::make(argv[1], std::stoi(argv[2]), std::string(argv[3]) == "grey" ? 1 : 3);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "make_recording: %s\n", e.what());
    return 1;
  }
}
