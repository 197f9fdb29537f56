#include <algorithm>

#include <trocar/sim/model/attached.hpp>

namespace trocar::sim {

bool is_attached(const Model& model, BodyId body, BodyId other) noexcept {
  const auto rides = [other](const interactions::Attachment& on) { return on.point.body == other; };
  if (body.is(BodyKind::membrane)) {
    const interactions::MembraneBody& m = model.membranes[body.index()];
    if (other.is(BodyKind::strand) && (m.strand == int(other.index()) || m.duct == int(other.index()))) return true;
    return std::any_of(m.holds.begin(), m.holds.end(), rides);
  }
  if (!body.is(BodyKind::strand)) return false;
  const interactions::StrandAnatomy& s = model.strands[body.index()];
  return rides(s.start.on) || rides(s.end.on);
}

}  // namespace trocar::sim
