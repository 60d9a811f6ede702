// Prints the tables of docs/memory.md, from what the compiler knows.
#include <cstdio>

#include "accrete/accumulator.h"

namespace {

double megabytes(std::size_t bytes) { return static_cast<double>(bytes) / 1e6; }

template <class Limits>
void row(const char* name) {
  std::printf("| `%s` | %zu x %zu | %zu | %zu | %zu | %.2f MB (%zu) |\n", name, Limits::kMaxImageWidth,
              Limits::kMaxImageHeight, Limits::kMaxPrimitives2d, Limits::kMaxPrimitives3d, Limits::kMaxStereoMatches,
              megabytes(sizeof(accrete::Accumulator<Limits>)), sizeof(accrete::Accumulator<Limits>));
}

// What one more of a capacity costs, the others at DefaultLimits.
void price(const char* name, std::size_t accrete::Capacities::*capacity, const char* unit) {
  constexpr std::size_t kStep = 1024;
  accrete::Capacities more = accrete::Accumulator<>::kCapacities;
  more.*capacity += kStep;
  const std::size_t bytes = accrete::storage_bytes(more) - accrete::storage_bytes(accrete::Accumulator<>::kCapacities);
  std::printf("| %s | %zu bytes %s |\n", name, bytes / kStep, unit);
}

}  // namespace

int main() {
  std::printf(
      "| limits | image of one eye | 2D-primitives an image | 3D-primitives | stereo matches | sizeof(Accumulator) "
      "|\n");
  std::printf("|---|---|---|---|---|---|\n");
  row<accrete::SmallLimits>("SmallLimits");
  row<accrete::DefaultLimits>("DefaultLimits");
  row<accrete::LargeLimits>("LargeLimits");
  std::printf("\n| capacity | costs |\n|---|---|\n");
  price("`kMaxPrimitives3d`", &accrete::Capacities::primitives3d, "each");
  price("`kMaxPrimitives2d`", &accrete::Capacities::primitives2d, "each, for both eyes together");
  price("`kMaxStereoMatches`", &accrete::Capacities::stereo_matches, "each");
  price("`kMaxImageHeight`", &accrete::Capacities::image_height, "a row at 1280 px width");
  price("`kMaxImageWidth`", &accrete::Capacities::image_width, "a column at 720 px height");
}
