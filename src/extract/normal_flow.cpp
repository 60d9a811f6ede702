#include "extract/normal_flow.h"

#include <cmath>

#include "base/angles.h"
#include "base/elementary.h"

namespace accrete::extract {

void measure_flow(const std::uint8_t* previous, std::ptrdiff_t stride, const Localised& edge, Primitive2d& primitive) {
  const int x = static_cast<int>(std::lround(edge.x_px)), y = static_cast<int>(std::lround(edge.y_px));
  const float nx = -edge.uy, ny = edge.ux;
  const Triple q = quadrature_at(previous, stride, x, y);
  const float odd = q.odd_x * nx + q.odd_y * ny;
  const float amplitude = std::sqrt(q.even * q.even + q.odd_x * q.odd_x + q.odd_y * q.odd_y);
  const float along = std::fabs(-q.odd_x * ny + q.odd_y * nx);
  primitive.has_flow = false;
  // The same structure: similar strength, and its gradient still across the edge (20 degrees). A slope below 0.3 rad/px
  // is a third of the band's centre frequency: no wave to measure a shift with.
  if (amplitude < 0.5F * edge.amplitude || amplitude > 2 * edge.amplitude) return;
  if (along > 0.36F * std::fabs(odd) + 0.25F * std::fabs(q.even)) return;
  if (std::fabs(edge.phase_slope) < 0.3F) return;
  // The pixel is off the edge by `offset` along the normal: refer the current phase to it.
  const float offset = (static_cast<float>(x) - edge.x_px) * nx + (static_cast<float>(y) - edge.y_px) * ny;
  const float now = edge.phase + offset * edge.phase_slope;
  const float flow = wrap_two_pi(atan2_of(odd, q.even) - now) / edge.phase_slope;
  if (std::fabs(flow) > 3.0F) return;  // half the band's centre wavelength of 6.5 px
  primitive.flow_px = flow;
  primitive.has_flow = true;
}

}  // namespace accrete::extract
