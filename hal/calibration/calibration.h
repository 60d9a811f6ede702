// Calibration files of stereo rigs. Every reader converts to p_r = T_r_l * p_l in metres; docs/reference/recordings.md
// has the conventions.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "accrete/camera.h"
#include "accrete/hal/stereo_source.h"

namespace accrete::hal {

struct Calibration {
  StereoRig rig;  // an image size of 0 x 0: the file states none
  // The frame that this kind's poses are about: EuRoC's body, KITTI's camera 0; identity elsewhere.
  Transform<Left, Body> T_l_b;
  bool knows_body = false;  // false: the file has no such frame
  std::string source;       // file names
  std::string convention;   // one sentence
  std::vector<std::string> guesses;
  bool complete = false;  // everything was read: what a reader then refuses is the rig, not the file
};

enum class KittiPair : std::uint8_t { kGrey = 0, kColour = 2 };  // the number of the left camera

// One file or several that complete each other (intrinsics.yml, extrinsics.yml).
Outcome read_opencv_stereo(std::span<const std::filesystem::path> files, Calibration& calibration);
// The two sensor.yaml of cam0 (left) and cam1.
Outcome read_euroc_pair(const std::filesystem::path& left, const std::filesystem::path& right,
                        Calibration& calibration);
// calib.txt of KITTI odometry; P0 and P1, or P0, P2 and P3.
Outcome read_kitti_calibration(const std::filesystem::path& path, KittiPair pair, Calibration& calibration);
// KITTI where a row begins with "P0:", OpenCV otherwise.
Outcome read_calibration_file(const std::filesystem::path& path, KittiPair pair, Calibration& calibration);
// Status of all of these: those of read_text and YamlFile::load; kNotFound (a key is missing), kUnsupported (a model or
// a unit that is not understood), kInvalidArgument (a value that cannot be right, see check_rig).

// Says what is wrong with a rig and what to do; image sizes of zero are let through. Status: kInvalidArgument.
Outcome check_rig(const StereoRig& rig, const std::string& source);
// The same for a matrix that should be a rotation; `name` says which.
Outcome check_rotation(const Mat3& m, const std::string& where, Quaternion& rotation);

// Distortion by a model's name in any of the usual spellings; empty: Brown-Conrady. All zeros become Distortion::kNone.
// Status: kUnsupported (unknown name, tilted sensor), kInvalidArgument (a number of coefficients that the model lacks).
Outcome set_distortion(const std::string& model, std::span<const double> coefficients, const std::string& where,
                       Camera& camera);

}  // namespace accrete::hal
