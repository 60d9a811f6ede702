#include "cli/evaluate/model_hash.h"

#include "cli/text/hash.h"

namespace accrete::cli {

static_assert(sizeof(Primitive3d) == 380,
              "Primitive3d has another member: add it to the hash below, then correct this size");

std::uint64_t model_hash(std::span<const Primitive3d> primitives) {
  Hash hash;
  for (const Primitive3d& p : primitives) {
    hash(p.id.index1);
    hash(p.id.generation);
    hash(static_cast<std::uint8_t>(p.state));
    hash(p.existence);
    hash(p.geometry.position);
    hash(p.geometry.quaternion);
    hash(p.geometry.covariance);
    hash(p.tangent);
    hash(p.appearance.mean.phase);
    hash(p.appearance.mean.left);
    hash(p.appearance.mean.right);
    hash(p.appearance.covariance);
    hash(p.observations);
    hash(p.misfit);
    hash(p.first_frame);
    hash(p.last_frame);
    hash(p.seen.hits);
    hash(p.seen.visits);
  }
  return hash.value();
}

}  // namespace accrete::cli
