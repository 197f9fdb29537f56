#include <trocar/training/facts/event_instance.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/clip_pair.hpp>

namespace trocar::training {
namespace {

ClipPair::Span span(const Argument& a) { return {a.low, a.high}; }

template <Value (*say)(const ClipPair&)>
class Pair final : public Observer {
 public:
  Pair(const sim::Model&, const Arguments& a)
      : m_pair({span(a[1]), span(a[2]), span(a[3]), span(a[4]), a[5].number(), a[6].number(), a[7].number()},
               a[0].index) {}
  void happened(const Snapshot& snapshot) override { m_pair.update(snapshot.state); }
  Value value(const Snapshot&) const override { return say(m_pair); }
  Value foretold(const Snapshot&, const EventInstance& h) const override {
    if (!h.foreseen) return say(m_pair);
    ClipPair with = m_pair;
    with.take(*h.foreseen);
    return say(with);
  }

 private:
  ClipPair m_pair;
};
Value first_set(const ClipPair& p) { return p.first_set(); }
Value second_set(const ClipPair& p) { return p.second_set(); }
Value misplaced(const ClipPair& p) { return p.misplaced(); }
Value apart(const ClipPair& p) { return p.paired() ? Value(p.apart()) : kUnknown; }

std::vector<Parameter> pair_parameters() {
  return {{"of", ArgumentKind::strand, "which tube"},
          {"first_mm", ArgumentKind::range, "position of the inner clip, from the tube's start"},
          {"second_mm", ArgumentKind::range, "position of the outer clip"},
          {"apart_mm", ArgumentKind::range, "between the two"},
          {"stretch_mm", ArgumentKind::range, "the stretch of the tube that may be clipped"},
          {"angle_deg", ArgumentKind::number, "largest angle to the cross-section", true, 0, 90},
          {"cover", ArgumentKind::number, "smallest share of the cross-section between the legs", true, 0, 1},
          {"closing_s", ArgumentKind::number, "shortest closing time", true, 0, 60}};
}

}  // namespace

const Fact kClipsFirstSet{"clips.first_set",
                          pair_parameters(),
                          0,
                          1,
                          "A well-set clip is at the position of the inner clip, with or without an outer one.",
                          needs_applier,
                          &remembering<Pair<first_set>>,
                          true};
const Fact kClipsSecondSet{"clips.second_set",
                           pair_parameters(),
                           0,
                           1,
                           "A well-set clip is at the position of the outer clip, with or without an inner one.",
                           needs_applier,
                           &remembering<Pair<second_set>>,
                           true};
const Fact kClipsMisplaced{"clips.misplaced",
                           pair_parameters(),
                           0,
                           1,
                           "The tube's last clip is well set, but it makes no pair and is at neither position of one.",
                           needs_applier,
                           &remembering<Pair<misplaced>>,
                           true};
const Fact kClipsApart{"clips.apart_mm",
                       pair_parameters(),
                       0,
                       1000,
                       "Distance between the two clips of the pair. Unknown until there is a pair.",
                       needs_applier,
                       &remembering<Pair<apart>>};

}  // namespace trocar::training
