#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

Value to_mark(const Look& look, const Arguments& a) {
  return length(tip_of(look.model, look.state, size_t(a[0].index)) - place_of_mark(look.model, look.state, a[1].index));
}
Value to_hand(const Look& look, const Arguments& a) {
  return length(tip_of(look.model, look.state, size_t(a[0].index)) -
                tip_of(look.model, look.state, size_t(a[1].index)));
}
Value tips_in_view(const Look& look, const Arguments& a) {
  return double(sim::jaw_tips_visible(look.model, look.state, a[0].index));
}
Value depth(const Look& look, const Arguments& a) { return look.state.tools[size_t(a[0].index)].depth; }

/// The tip's way so far.
class Path final : public Observer {
 public:
  Path(const sim::Model& model, const Arguments& a) : m_hand(size_t(a[0].index)) {
    m_before = tip_of(model, sim::initial_state(model), m_hand);
  }
  void sample(const Look& look, double) override {
    const Vec3d now = tip_of(look.model, look.state, m_hand);
    m_way += length(now - m_before);
    m_before = now;
  }
  Value value(const Look&) const override { return m_way; }

 private:
  size_t m_hand;
  Vec3d m_before;
  double m_way = 0;
};

}  // namespace

const Fact kHandTipToMark{"hand.tip_to_mark_mm",
                          {{"hand", ArgumentKind::hand, "whose instrument"}, {"mark", ArgumentKind::mark, "to which"}},
                          0,
                          1000,
                          "From the instrument's tip to the mark's middle.",
                          anywhere,
                          &stateless<to_mark>};
const Fact kHandTipToHand{"hand.tip_to_hand_mm",
                          {{"hand", ArgumentKind::hand, "whose instrument"}, {"other", ArgumentKind::hand, "to whose"}},
                          0,
                          1000,
                          "Between the tips of two instruments.",
                          anywhere,
                          &stateless<to_hand>};
const Fact kHandTipsInView{"hand.tips_in_view",
                           {{"hand", ArgumentKind::hand, "whose instrument"}},
                           0,
                           2,
                           "How many of the instrument's two jaw tips are in view.",
                           anywhere,
                           &stateless<tips_in_view>};
const Fact kHandDepth{"hand.depth_mm",
                      {{"hand", ArgumentKind::hand, "whose instrument"}},
                      0,
                      400,
                      "How deep the instrument is in, from its trocar.",
                      anywhere,
                      &stateless<depth>};
const Fact kHandPath{"hand.path_mm",
                     {{"hand", ArgumentKind::hand, "whose instrument"}},
                     0,
                     1e6,
                     "The way of the instrument's tip so far.",
                     anywhere,
                     &remembering<Path>};

}  // namespace trocar::training
