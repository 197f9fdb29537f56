// A clip that has closed: on a strand or a vessel, or on nothing.
#include <algorithm>
#include <span>

#include <trocar/training/events/registry.hpp>
#include <trocar/training/exercise/hands.hpp>
#include <trocar/training/observe/liquid.hpp>

namespace trocar::training {
namespace {

const interactions::Clip& clip_of(const Look& look, const Happening& h) { return look.state.clips[size_t(h.number)]; }

Happening happening(const Look& look, int number) {
  const interactions::Clip& clip = look.state.clips[size_t(number)];
  Happening h{clip.tool, clip.strand, number, nullptr, tip_of(look.model, look.state, size_t(clip.tool)), {}};
  h.where = h.tip;
  if (clip.strand < 0) {
    if (clip.vessel > 0) h.name = &look.model.vessels.list[size_t(clip.vessel - 1)].name;
    return h;
  }
  const size_t i = size_t(clip.strand);
  h.name = &look.model.strands[i].name;
  h.where = interactions::point_at(look.model.strand_bodies[i], look.state.strands[i],
                                   interactions::place_at(look.model.strand_bodies[i], clip.s));
  return h;
}

template <bool lost>
class Clips final : public Noticer {
 public:
  Clips(const sim::Model&, const Arguments&) {}
  void tick(const Look& look, const sim::StepReport&, Happenings& out) override {
    for (; m_seen < look.state.clip_count; ++m_seen)
      if (look.state.clips[size_t(m_seen)].dropped() == lost) out.add(happening(look, m_seen));
  }

 private:
  std::int32_t m_seen = 0;
};

/// What the clip does to the vessel that bleeds by itself; null: nothing.
const interactions::VesselClip* on_bleeder(const Look& look, const Happening& h) {
  const auto closed = std::span(look.state.vessel_clips).first(size_t(look.state.vessel_clip_count));
  const auto at = std::find_if(closed.begin(), closed.end(), [&](const interactions::VesselClip& c) {
    return c.clip == h.number && c.vessel == look.model.vessels.bleeder.vessel;
  });
  return at == closed.end() ? nullptr : &*at;
}

std::vector<Attribute> attributes() {
  return {
      {"s_mm", "where on the strand, from its beginning; unknown on a bare vessel",
       [](const Look& l, const Happening& h) { return h.body < 0 ? kUnknown : Value(clip_of(l, h).s); }},
      {"angle_deg", "off the cross-section",
       [](const Look& l, const Happening& h) -> Value { return clip_of(l, h).theta; }},
      {"cover", "share of the cross-section between the legs",
       [](const Look& l, const Happening& h) -> Value { return clip_of(l, h).cover; }},
      {"closing_s", "how long the jaws took from half open",
       [](const Look& l, const Happening& h) -> Value { return clip_of(l, h).closing_time; }},
      {"tips_visible", "of the two jaw tips, when it closed",
       [](const Look& l, const Happening& h) -> Value { return double(clip_of(l, h).tips_visible); }, false, true},
      {"under_liquid", "the pool stood over the jaws",
       [](const Look& l, const Happening& h) -> Value { return l.model.wet.there && drowned(l.model, l.state, h.tip); },
       true},
      {"on_bleeder", "it closes the vessel that bleeds by itself",
       [](const Look& l, const Happening& h) -> Value { return on_bleeder(l, h) != nullptr; }, true},
      {"bleeder_cover", "share of that vessel between the legs; unknown elsewhere",
       [](const Look& l, const Happening& h) {
         const auto* c = on_bleeder(l, h);
         return c ? Value(c->cover) : kUnknown;
       }},
      {"upstream", "on the heart's side of the bleeding place; unknown elsewhere",
       [](const Look& l, const Happening& h) {
         const auto* c = on_bleeder(l, h);
         return c ? Value(c->s < l.model.vessels.bleeder.s) : kUnknown;
       },
       true},
  };
}

}  // namespace

const EventKind kClipped{
    "clipped", {}, attributes(), "A clip closed on a strand or a vessel.", anywhere, &noticing<Clips<false>>, true};
const EventKind kClipLost{"clip_lost", {}, {}, "A clip closed on nothing.", anywhere, &noticing<Clips<true>>};

}  // namespace trocar::training
