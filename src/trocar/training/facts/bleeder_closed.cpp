// What has been done about the vessel that opens by itself.
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/bleeder.hpp>

namespace trocar::training {
namespace {

Value clipped(const Snapshot& snapshot, const Arguments& a) {
  return bleeder_clipped(snapshot.model, snapshot.state, a[0].word == "heart", a[1].number());
}

Value sealed(const Snapshot& snapshot, const Arguments&) { return bleeder_sealed(snapshot.model, snapshot.state); }

}  // namespace

const Fact kBleederClipped{
    "bleeder.clipped",
    {{"side",
      ArgumentKind::word,
      "side of the bleeding point: towards the heart, or beyond",
      true,
      0,
      0,
      {"heart", "beyond"}},
     {"cover", ArgumentKind::number, "share of the vessel's width from which a clip closes it", true, 0, 1}},
    0,
    1,
    "A clip closes the bleeding vessel on that side of the bleeding point.",
    needs_bleeder,
    &stateless<clipped>,
    true};
const Fact kBleederSealed{"bleeder.sealed",
                          {},
                          0,
                          1,
                          "Heat has sealed the bleeding vessel, at the bleeding point or on the heart's side of it, "
                          "so that it withstands three times a systolic pressure.",
                          needs_bleeder,
                          &stateless<sealed>,
                          true};

}  // namespace trocar::training
