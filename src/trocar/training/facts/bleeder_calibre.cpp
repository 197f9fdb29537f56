#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value calibre(const Snapshot& snapshot, const Arguments&) {
  const sim::Bleeder& b = snapshot.model.vessels.bleeder;
  const vessels::FlowSegment& segment = snapshot.model.vessels.flow.segments[size_t(b.vessel)];
  return 2 * (segment.radius + segment.taper * b.s);
}

}  // namespace

const Fact kBleederCalibre{"bleeder.calibre_mm",
                           {},
                           0,
                           100,
                           "Diameter of the bleeding vessel's lumen at the bleeding point, undeformed.",
                           needs_bleeder,
                           &stateless<calibre>};

}  // namespace trocar::training
