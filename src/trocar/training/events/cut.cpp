// What scissors parted: a strand, an organ, a fold.
#include <cmath>

#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/liquid.hpp>
#include <trocar/training/observe/loops.hpp>

namespace trocar::training {
namespace {

const interactions::Cut& cut_of(const Snapshot& snapshot, const EventInstance& h) {
  return snapshot.state.cuts[size_t(h.number)];
}

class Cuts final : public EventDetector {
 public:
  Cuts(const sim::Model&, const Arguments&) {}
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    for (; m_seen < snapshot.state.cut_count; ++m_seen) {
      const interactions::Cut& cut = snapshot.state.cuts[size_t(m_seen)];
      const Vec3d tip = tip_of(snapshot.model, snapshot.state, size_t(cut.tool));
      EventInstance h{cut.tool, cut.body(), m_seen, nullptr, tip, tip};
      h.name = name_of_body(snapshot.model, h.body);
      if (cut.strand >= 0) {
        const interactions::StrandBody& body = snapshot.model.strand_bodies[size_t(cut.strand)];
        h.where = interactions::point_at(body, snapshot.state.strands[size_t(cut.strand)],
                                         interactions::place_at(body, cut.s));
      }
      out.add(h);
    }
  }

 private:
  std::int32_t m_seen = 0;
};

/// Where a fold that the strand carries is a body it says how deep it was cut; otherwise the blades' reach beyond the
/// strand stands for it.
Value depth(const Snapshot& snapshot, const EventInstance& h) {
  const interactions::Cut& cut = cut_of(snapshot, h);
  bool fold = cut.strand < 0;
  for (const auto& membrane : snapshot.model.membranes) fold = fold || membrane.strand == cut.strand;
  return fold ? cut.fold : cut.beyond;
}

template <class Visit>
void each_clip(const Snapshot& snapshot, const EventInstance& h, Visit&& visit) {
  for (int i = 0; i < snapshot.state.clip_count; ++i) {
    const interactions::Clip& clip = snapshot.state.clips[size_t(i)];
    if (clip.strand >= 0 && clip.strand == cut_of(snapshot, h).strand) visit(clip.s);
  }
}

Value between_clips(const Snapshot& snapshot, const EventInstance& h) {
  const double at = cut_of(snapshot, h).s;
  bool below = false, above = false;
  each_clip(snapshot, h, [&](double s) {
    below = below || s < at;
    above = above || s > at;
  });
  return below && above;
}

Value cut_to_clip(const Snapshot& snapshot, const EventInstance& h) {
  const double at = cut_of(snapshot, h).s;
  Value nearest = kUnknown;
  each_clip(snapshot, h, [&](double s) {
    const double off = std::fabs(s - at);
    if (!nearest.known || off < nearest.number) nearest = off;
  });
  return nearest;
}

Value between_loops(const Snapshot& snapshot, const EventInstance& h) {
  const interactions::Cut& cut = cut_of(snapshot, h);
  if (cut.strand < 0) return false;
  const SecuredLoops loops = secured_loops(snapshot.model, snapshot.state, cut.strand);
  return loops.count > 1 && loops.at[0] < cut.s && loops.at[size_t(loops.count) - 1] > cut.s;
}

Value cut_to_loop(const Snapshot& snapshot, const EventInstance& h) {
  const interactions::Cut& cut = cut_of(snapshot, h);
  Value nearest = kUnknown;
  if (cut.strand < 0) return nearest;
  const SecuredLoops loops = secured_loops(snapshot.model, snapshot.state, cut.strand);
  for (int i = 0; i < loops.count; ++i) {
    const double off = std::fabs(loops.at[size_t(i)] - cut.s);
    if (!nearest.known || off < nearest.number) nearest = off;
  }
  return nearest;
}

std::vector<Attribute> cut_attributes() {
  return {
      {"s_mm", "where on the strand, from its beginning; unknown on other bodies",
       [](const Snapshot& m, const EventInstance& h) {
         return cut_of(m, h).strand < 0 ? kUnknown : Value(cut_of(m, h).s);
       },
       0, kLongest},
      {"fraction", "share of the strand's cross-section that was cut; unknown on other bodies",
       [](const Snapshot& m, const EventInstance& h) {
         return cut_of(m, h).strand < 0 ? kUnknown : Value(cut_of(m, h).fraction);
       },
       0, 1},
      {"depth_mm", "how deep the blades went into the fold behind the strand, or into the fold", depth, 0, kLongest},
      {"tips_visible", "number of the two jaw tips in view during the cut",
       [](const Snapshot& m, const EventInstance& h) -> Value { return double(cut_of(m, h).tips_visible); }, 0, 2,
       false, true},
      {"under_liquid", "the jaws were under the surface of pooled fluid",
       [](const Snapshot& m, const EventInstance& h) -> Value {
         return m.model.wet.there && drowned(m.model, m.state, h.tip);
       },
       0, 1, true},
      {"between_clips", "clips sit on the strand on both sides of the cut", between_clips, 0, 1, true},
      {"to_clip_mm", "distance to the strand's nearest clip; unknown without one", cut_to_clip, 0, kLongest},
      {"between_loops", "loops with their tails cut close the strand on both sides of the cut", between_loops, 0, 1,
       true},
      {"to_loop_mm", "distance to the nearest of these loops; unknown without one", cut_to_loop, 0, kLongest},
  };
}

}  // namespace

const EventKind kCut{"cut", {}, cut_attributes(), "Scissors cut into a body.", needs_scissors, &make_detector<Cuts>,
                     true};

}  // namespace trocar::training
