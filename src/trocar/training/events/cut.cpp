// What scissors parted: a strand, an organ, a fold.
#include <cmath>

#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/liquid.hpp>

namespace trocar::training {
namespace {

const interactions::Cut& cut_of(const Look& look, const Happening& h) { return look.state.cuts[size_t(h.number)]; }

class Cuts final : public Noticer {
 public:
  Cuts(const sim::Model&, const Arguments&) {}
  void tick(const Look& look, const sim::StepReport&, Happenings& out) override {
    for (; m_seen < look.state.cut_count; ++m_seen) {
      const interactions::Cut& cut = look.state.cuts[size_t(m_seen)];
      const Vec3d tip = tip_of(look.model, look.state, size_t(cut.tool));
      Happening h{cut.tool, cut.body(), m_seen, nullptr, tip, tip};
      h.name = name_of_body(look.model, h.body);
      if (cut.strand >= 0) {
        const interactions::StrandBody& body = look.model.strand_bodies[size_t(cut.strand)];
        h.where =
            interactions::point_at(body, look.state.strands[size_t(cut.strand)], interactions::place_at(body, cut.s));
      }
      out.add(h);
    }
  }

 private:
  std::int32_t m_seen = 0;
};

/// Where a fold that the strand carries is a body it says how deep it was cut; otherwise the blades' reach beyond the
/// strand stands for it.
Value depth(const Look& look, const Happening& h) {
  const interactions::Cut& cut = cut_of(look, h);
  bool fold = cut.strand < 0;
  for (const auto& membrane : look.model.membranes) fold = fold || membrane.strand == cut.strand;
  return fold ? cut.fold : cut.beyond;
}

template <class Visit>
void each_clip(const Look& look, const Happening& h, Visit&& visit) {
  for (int i = 0; i < look.state.clip_count; ++i) {
    const interactions::Clip& clip = look.state.clips[size_t(i)];
    if (clip.strand >= 0 && clip.strand == cut_of(look, h).strand) visit(clip.s);
  }
}

Value between_clips(const Look& look, const Happening& h) {
  const double at = cut_of(look, h).s;
  bool below = false, above = false;
  each_clip(look, h, [&](double s) {
    below = below || s < at;
    above = above || s > at;
  });
  return below && above;
}

Value cut_to_clip(const Look& look, const Happening& h) {
  const double at = cut_of(look, h).s;
  Value nearest = kUnknown;
  each_clip(look, h, [&](double s) {
    const double off = std::fabs(s - at);
    if (!nearest.known || off < nearest.number) nearest = off;
  });
  return nearest;
}

std::vector<Attribute> cut_attributes() {
  return {
      {"s_mm", "where on the strand, from its beginning; unknown on other bodies",
       [](const Look& l, const Happening& h) { return cut_of(l, h).strand < 0 ? kUnknown : Value(cut_of(l, h).s); }, 0,
       kLongest},
      {"fraction", "of the strand's cross-section that was cut; unknown on other bodies",
       [](const Look& l, const Happening& h) {
         return cut_of(l, h).strand < 0 ? kUnknown : Value(cut_of(l, h).fraction);
       },
       0, 1},
      {"depth_mm", "how deep the blades went into the fold behind the strand, or into the fold", depth, 0, kLongest},
      {"tips_visible", "of the two jaw tips, when it was cut",
       [](const Look& l, const Happening& h) -> Value { return double(cut_of(l, h).tips_visible); }, 0, 2, false, true},
      {"under_liquid", "the pool stood over the jaws",
       [](const Look& l, const Happening& h) -> Value { return l.model.wet.there && drowned(l.model, l.state, h.tip); },
       0, 1, true},
      {"between_clips", "clips sit on the strand on both sides of the cut", between_clips, 0, 1, true},
      {"to_clip_mm", "from the strand's nearest clip; unknown without any", cut_to_clip, 0, kLongest},
  };
}

}  // namespace

const EventKind kCut{"cut", {}, cut_attributes(), "Scissors cut into a body.", needs_scissors, &noticing<Cuts>, true};

}  // namespace trocar::training
