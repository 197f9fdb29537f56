#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/liquid.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

Value under(const Snapshot& snapshot, const Arguments& a) {
  return drowned(snapshot.model, snapshot.state, place_of_mark(snapshot.model, snapshot.state, a[0].index));
}

}  // namespace

const Fact kMarkUnderLiquid{"mark.under_liquid",
                            {{"of", ArgumentKind::mark, "which"}},
                            0,
                            1,
                            "Pooled fluid covers the mark's centre, too deep to see through.",
                            needs_fluids,
                            &stateless<under>,
                            true};

}  // namespace trocar::training
