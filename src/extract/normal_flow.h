// Normal optic flow from the change of local phase since the previous image (aperture: only this component is visible).
#pragma once

#include "accrete/primitive.h"
#include "extract/localise.h"

namespace accrete::extract {

// Sets flow_px and has_flow of `primitive`. `previous` is the previous grey image. The flow is measurable while it is
// shorter than half the wavelength of the band-pass; longer ones are recognised by amplitude and orientation and
// refused.
void measure_flow(const std::uint8_t* previous, std::ptrdiff_t stride, const Localised& edge, Primitive2d& primitive);

}  // namespace accrete::extract
