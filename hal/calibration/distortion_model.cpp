#include <algorithm>
#include <cctype>

#include "calibration/calibration.h"
#include "text/sentence.h"

namespace accrete::hal {
namespace {

// "Radial-Tangential" and "radial_tangential" are one name.
std::string plain(std::string name) {
  std::erase_if(name, [](unsigned char c) { return std::isalnum(c) == 0; });
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

bool among(const std::string& name, std::span<const char* const> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* n) { return name == n; });
}

constexpr const char* kNone[] = {"none", "pinholenone", "rectified"};
constexpr const char* kBrown[] = {"",        "brownconrady",       "plumbbob", "radtan", "radialtangential",
                                  "pinhole", "rationalpolynomial", "brown",    "opencv", "pinholeradtan"};
constexpr const char* kKannala[] = {"fisheye",        "equidistant", "kannalabrandt", "kannalabrandt4",
                                    "kannalabrandt8", "kb4",         "opencvfisheye", "pinholeequi"};

}  // namespace

Outcome set_distortion(const std::string& model, std::span<const double> coefficients, const std::string& where,
                       Camera& camera) {
  camera.coefficients = {};
  camera.distortion = Distortion::kNone;
  const std::string name = plain(model);
  const std::size_t n = coefficients.size();
  if (among(name, kNone)) return {};
  if (among(name, kBrown)) {
    if (n != 0 && n != 4 && n != 5 && n != 8 && n != 12 && n != 14)
      return {Status::kInvalidArgument, where + " has " + count(n, "coefficient") +
                                            "; k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4]]] are 4, 5, 8 or 12"};
    if (n == 14 && (coefficients[12] != 0 || coefficients[13] != 0))
      return {Status::kUnsupported,
              where + " has a tilted sensor (tau_x, tau_y), which is not understood: calibrate without it"};
    std::copy_n(coefficients.begin(), std::min<std::size_t>(n, 12), camera.coefficients.begin());
    const bool zero = std::all_of(coefficients.begin(), coefficients.end(), [](double k) { return k == 0; });
    if (!zero) camera.distortion = Distortion::kBrownConrady;
    return {};
  }
  if (among(name, kKannala)) {
    if (n != 4)
      return {Status::kInvalidArgument,
              where + " has " + count(n, "coefficient") + "; a fisheye (Kannala-Brandt) has 4: k1 k2 k3 k4"};
    std::copy_n(coefficients.begin(), 4, camera.coefficients.begin());
    camera.distortion = Distortion::kKannalaBrandt;
    return {};
  }
  return {Status::kUnsupported, where + " has the model " + in_quotes(model) +
                                    "; understood are none, radial-tangential (plumb_bob, rational_polynomial) and "
                                    "equidistant (fisheye): calibrate with one of these"};
}

}  // namespace accrete::hal
