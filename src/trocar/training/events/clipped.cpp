// A clip that has closed: on a strand, a vessel or a thread, or on nothing.
#include <algorithm>
#include <cmath>
#include <span>

#include <trocar/interactions/objects/suture_clip.hpp>
#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/bleeder.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/liquid.hpp>

namespace trocar::training {
namespace {

const interactions::Clip& clip_of(const Snapshot& snapshot, const EventInstance& h) {
  return h.foreseen ? *h.foreseen : snapshot.state.clips[size_t(h.number)];
}

EventInstance instance(const Snapshot& snapshot, const interactions::Clip& clip, int number) {
  EventInstance h{clip.tool, clip.body(), number, nullptr, tip_of(snapshot.model, snapshot.state, size_t(clip.tool)),
                  {}};
  h.where = h.tip;
  if (clip.strand < 0) {
    if (clip.on_thread())
      h.name = &interactions::part_of<interactions::Suture>(snapshot.model).list[h.body.index()].name;
    if (clip.vessel > 0) h.name = &snapshot.model.vessels.list[size_t(clip.vessel - 1)].name;
    return h;
  }
  const size_t i = size_t(clip.strand);
  h.name = &snapshot.model.strands[i].name;
  h.where = interactions::point_at(snapshot.model.strand_bodies[i], snapshot.state.strands[i],
                                   interactions::place_at(snapshot.model.strand_bodies[i], clip.s));
  return h;
}

template <bool lost>
class Clips final : public EventDetector {
 public:
  Clips(const sim::Model&, const Arguments&) {}
  void tick(const Snapshot& snapshot, const sim::StepReport&, EventInstances& out) override {
    for (; m_seen < snapshot.state.clip_count; ++m_seen)
      if (snapshot.state.clips[size_t(m_seen)].dropped() == lost)
        out.add(instance(snapshot, snapshot.state.clips[size_t(m_seen)], m_seen));
  }

 private:
  std::int32_t m_seen = 0;
};

/// What the clip does to the vessel that bleeds by itself; null: nothing.
const interactions::VesselClip* on_bleeder(const Snapshot& snapshot, const EventInstance& h) {
  const auto closed = std::span(snapshot.state.vessel_clips).first(size_t(snapshot.state.vessel_clip_count));
  const auto at = std::find_if(closed.begin(), closed.end(), [&](const interactions::VesselClip& c) {
    return c.clip == h.number && c.vessel == snapshot.model.vessels.bleeder.vessel;
  });
  return at == closed.end() ? nullptr : &*at;
}

/// From the clip to the nearest stripe around its strand.
Value to_mark(const Snapshot& snapshot, const EventInstance& h) {
  Value nearest = kUnknown;
  for (const sim::MarkModel& mark : snapshot.model.marks) {
    if (!mark.is_stripe() || h.body != mark.at.body) continue;
    const double off = std::fabs(mark.s - clip_of(snapshot, h).s);
    if (!nearest.known || off < nearest.number) nearest = off;
  }
  return nearest;
}

/// The clip as it sits on a thread; null: on none.
const suture::ThreadClip* on_thread(const Snapshot& snapshot, const EventInstance& h) {
  return interactions::thread_clip(snapshot.state.objects.sutures, clip_of(snapshot, h), h.number);
}

/// From the clip to the nearest one that was there before.
Value clip_to_clip(const Snapshot& snapshot, const EventInstance& h) {
  Value nearest = kUnknown;
  for (int i = 0; i < h.number; ++i) {
    const interactions::Clip& other = snapshot.state.clips[size_t(i)];
    if (!h.body.exists() || h.body != other.body()) continue;
    const double off = std::fabs(other.s - clip_of(snapshot, h).s);
    if (!nearest.known || off < nearest.number) nearest = off;
  }
  return nearest;
}

std::vector<Attribute> clip_attributes() {
  return {
      {"s_mm", "where on the strand or the thread, from its beginning; unknown on a bare vessel",
       [](const Snapshot& m, const EventInstance& h) { return !h.body.exists() ? kUnknown : Value(clip_of(m, h).s); },
       0, kLongest},
      {"angle_deg", "off the cross-section",
       [](const Snapshot& m, const EventInstance& h) -> Value { return clip_of(m, h).theta; }, 0, 90},
      {"cover", "share of the cross-section between the legs",
       [](const Snapshot& m, const EventInstance& h) -> Value { return clip_of(m, h).cover; }, 0, 1},
      {"to_mark_mm", "distance along the strand to the nearest stripe around it; unknown without a stripe", to_mark, 0,
       kLongest},
      {"to_clip_mm", "distance along the strand or the thread to the nearest earlier clip; unknown without one",
       clip_to_clip, 0, kLongest},
      {"closing_s", "time that the jaws took to close from half open",
       [](const Snapshot& m, const EventInstance& h) {
         return h.foreseen ? kUnknown : Value(clip_of(m, h).closing_time);
       },
       0, 3600},
      {"tips_visible", "number of the two jaw tips in view when it closed",
       [](const Snapshot& m, const EventInstance& h) -> Value { return double(clip_of(m, h).tips_visible); }, 0, 2,
       false, true},
      {"under_liquid", "the jaws were under the surface of pooled fluid",
       [](const Snapshot& m, const EventInstance& h) -> Value {
         return m.model.wet.there && drowned(m.model, m.state, h.tip);
       },
       0, 1, true},
      {"on_bleeder", "the clip closes the bleeding vessel",
       [](const Snapshot& m, const EventInstance& h) {
         return h.foreseen ? kUnknown : Value(on_bleeder(m, h) != nullptr);
       },
       0, 1, true},
      {"bleeder_cover", "share of the bleeding vessel between the legs; unknown elsewhere",
       [](const Snapshot& m, const EventInstance& h) {
         const auto* c = on_bleeder(m, h);
         return c ? Value(c->cover) : kUnknown;
       },
       0, 1},
      {"upstream", "the clip is on the heart's side of the bleeding point; unknown elsewhere",
       [](const Snapshot& m, const EventInstance& h) {
         const auto* c = on_bleeder(m, h);
         return c ? Value(on_hearts_side(m.model.vessels.bleeder, c->s)) : kUnknown;
       },
       0, 1, true},
      {"on_thread", "it closed on thread, with no strand and no vessel between its legs",
       [](const Snapshot& m, const EventInstance& h) { return Value(clip_of(m, h).on_thread()); }, 0, 1, true},
      {"stretches", "length of thread between its legs; 0 on tissue",
       [](const Snapshot& m, const EventInstance& h) {
         const suture::ThreadClip* c = on_thread(m, h);
         return Value(c ? double(c->count) : 0.0);
       },
       0, suture::kMostClipped, false, true},
  };
}

/// What the clip would be if the applier closed now. It closes slowly, and what it would do to vessels is not known.
bool foresee(const Snapshot& snapshot, int hand, Foreseen& out) {
  const interactions::ToolModel& applier = snapshot.model.tool(snapshot.state, size_t(hand));
  const interactions::ToolState& tool = snapshot.state.tools[size_t(hand)];
  if (!applier.can().set_clips || !tool.armed) return false;
  const interactions::ToolShape shape = sim::shape_of(snapshot.model, snapshot.state, size_t(hand));
  out.clip = {};
  interactions::fit_clip(applier, shape, sim::bodies_of(snapshot.model, snapshot.state), out.clip);
  if (out.clip.strand < 0) return false;
  out.clip.tool = hand;
  out.clip.closing_time = 3600;
  out.clip.tips_visible = sim::jaw_tips_visible(snapshot.model, snapshot.state, hand);
  out.instance = instance(snapshot, out.clip, -1);
  out.instance.foreseen = &out.clip;
  return true;
}

}  // namespace

const EventKind kClipped{"clipped",
                         {},
                         clip_attributes(),
                         "A clip closed on a strand, a vessel or a thread.",
                         needs_applier,
                         &make_detector<Clips<false>>,
                         true,
                         EventKind::Hold::none,
                         foresee};
const EventKind kClipLost{"clip_lost", {}, {}, "A clip closed on nothing.", needs_applier, &make_detector<Clips<true>>};

}  // namespace trocar::training
