// The vessel that opens by itself: how wide it is, and what has been done about it.
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/observe/liquid.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

Value calibre(const Look& look, const Arguments&) {
  const sim::Bleeder& b = look.model.vessels.bleeder;
  const vessels::FlowSegment& segment = look.model.vessels.flow.segments[size_t(b.vessel)];
  return 2 * (segment.radius + segment.taper * b.s);
}

Value clipped(const Look& look, const Arguments& a) {
  return bleeder_clipped(look.model, look.state, a[0].word == "heart", a[1].number());
}

Value sealed(const Look& look, const Arguments&) { return bleeder_sealed(look.model, look.state); }

/// What stands under the pool cannot be controlled yet: that time does not count.
class Uncovered final : public Observer {
 public:
  Uncovered(const sim::Model& model, const Arguments&) : m_mark(model.target_index("bleeder")) {}
  void sample(const Look& look, double passed) override {
    if (look.state.tick < look.model.vessels.bleeder.tick) return;
    if (!drowned(look.model, look.state, place_of_mark(look.model, look.state, m_mark))) m_free += passed;
  }
  Value value(const Look&) const override { return m_free; }

 private:
  int m_mark;
  double m_free = 0;  ///< [s]
};

std::string_view needs_bleeder(const sim::Model& model) { return model.vessels.bleeder.vessel >= 0 ? "" : "bleeder"; }
std::string_view needs_bleeder_in_pool(const sim::Model& model) {
  if (!needs_bleeder(model).empty()) return needs_bleeder(model);
  if (model.target_index("bleeder") < 0) return "a bleeder that can be told";  // nothing carries it
  return model.wet.there ? "" : "fluids";
}

}  // namespace

const Fact kBleederCalibre{"bleeder.calibre_mm",
                           {},
                           0,
                           100,
                           "Of the lumen of the vessel that opens by itself, at that place, as drawn.",
                           needs_bleeder,
                           &stateless<calibre>};
const Fact kBleederClipped{
    "bleeder.clipped",
    {{"side",
      ArgumentKind::word,
      "of the place: where its blood comes from, or beyond it",
      true,
      0,
      0,
      {"heart", "beyond"}},
     {"cover", ArgumentKind::number, "share of its width from which a clip closes it", true, 0, 1}},
    0,
    1,
    "A clip closes the vessel that opens by itself on that side of the place.",
    needs_bleeder,
    &stateless<clipped>,
    true};
const Fact kBleederSealed{"bleeder.sealed",
                          {},
                          0,
                          1,
                          "Heat has closed the vessel that opens by itself, at the place or on the heart's side of it, "
                          "so that it bears three times a systolic pressure.",
                          needs_bleeder,
                          &stateless<sealed>,
                          true};
const Fact kBleederUncovered{"bleeder.uncovered_s",
                             {},
                             0,
                             36000,
                             "For how long, all in all, the place that opens by itself has been open without the pool "
                             "standing over it.",
                             needs_bleeder_in_pool,
                             &remembering<Uncovered>};

}  // namespace trocar::training
