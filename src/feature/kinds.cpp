// The kinds that there are, compiled as the core is, for every target: what a kind lacks shows here.
#include "feature/birth.h"
#include "feature/edge.h"
#include "feature/judge.h"
#include "feature/junction.h"
#include "feature/motion.h"
#include "feature/patch.h"

namespace accrete::inline ACCRETE_ISA {
namespace feature {

static_assert(Feature<Edge> && Feature<Junction<2>> && Feature<Junction<3>> && Feature<Junction<4>> && Feature<Patch>);
static_assert(Reconstructible<Junction<3>, float> && Reconstructible<Patch, float> && !Reconstructible<Edge, float>);
static_assert(Visible<Junction<4>, Lanes> && Manifold<Patch, Lanes>);

// NOLINTBEGIN(bugprone-macro-parentheses): F is a type
#define ACCRETE_KIND(F)                                                                                               \
  template Updated<float> update<F, 1, float>(Estimate<F, float>&, const Camera<float>*, const ViewOf<F, float>*);    \
  template Updated<float> update<F, 2, float>(Estimate<F, float>&, const Camera<float>*, const ViewOf<F, float>*);    \
  template bool add_motion_noise<F, float>(Estimate<F, float>&, const MotionNoise&);                                  \
  template void associate_features<F>(std::span<const Expected<F>>, const Camera<float>*, BothSeen<F>,                \
                                      std::span<associate::Hypothesis>, std::span<std::int32_t>,                      \
                                      std::span<std::int32_t>, std::span<associate::Association>);                    \
  template existence::Verdict judge<F>(History<F>&, const associate::Association&, const Expected<F>&,                \
                                       const Camera<float>*, BothSeen<F>, const std::array<float, 3>&, std::uint32_t, \
                                       const ExistenceParams&)
#define ACCRETE_BIRTH(F) \
  template ReconstructOutcome birth<F, float>(const ViewOf<F, float>*, const AlignedOptics&, Estimate<F, float>&)
// NOLINTEND(bugprone-macro-parentheses)
ACCRETE_KIND(Edge);
ACCRETE_KIND(Junction<4>);
ACCRETE_BIRTH(Junction<4>);
ACCRETE_KIND(Patch);
ACCRETE_BIRTH(Patch);

}  // namespace feature
}  // namespace accrete::inline ACCRETE_ISA
