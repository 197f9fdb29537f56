// How far an instrument's tip is from something.
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

Value to_mark(const Moment& moment, const Arguments& a) {
  return length(tip_of(moment.model, moment.state, size_t(a[0].index)) -
                place_of_mark(moment.model, moment.state, a[1].index));
}
Value to_hand(const Moment& moment, const Arguments& a) {
  return length(tip_of(moment.model, moment.state, size_t(a[0].index)) -
                tip_of(moment.model, moment.state, size_t(a[1].index)));
}

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

}  // namespace trocar::training
