// Report of a tick: its events, and flags for what went wrong.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include <trocar/core/body_id.hpp>
#include <trocar/tissue/base/report.hpp>

namespace trocar::sim {

/// Something that happened in a tick. Each field has one meaning; a field that this kind of event does not have keeps
/// its default. An Event is made by the maker of its kind's content: a kind of another content does not compile.
class Event {
 public:
  enum Kind : std::int32_t {
    none,
    grasped,
    released,
    slipped,
    clipped,
    dropped_clip,
    cut,
    exchanged,
    torn,
    parted,
    declared,
    pierced,
    injected,
    loop_tightened,
    loop_loosened,
    loop_slipped,
    loop_cut,
    thread_cut,
    thread_broken,
    clip_blocked
  };
  /// What an event of a kind holds beside its hand.
  enum class Content { hand_only, body, record, instrument };
  static constexpr Content content_of(Kind kind) noexcept {
    switch (kind) {
      case clipped:
      case dropped_clip:
      case cut:
        return Content::record;
      case exchanged:
        return Content::instrument;
      case none:
      case released:
      case slipped:
      case declared:
      case clip_blocked:
        return Content::hand_only;
      default:
        return Content::body;
    }
  }

  /// A kind with that content: a constant of any other kind does not convert to it.
  template <Content content>
  struct KindWith {
    Kind kind;
    consteval KindWith(Kind k) : kind(k) {
      if (k == none || content_of(k) != content) throw "an event of this kind has another content";
    }
  };

  Event() = default;
  static Event of_hand(KindWith<Content::hand_only> kind, int hand) noexcept { return {kind.kind, hand, {}, -1, -1}; }
  /// @param hand  -1: no hand caused it  @param body  that it happened to
  static Event on_body(KindWith<Content::body> kind, int hand, BodyId body) noexcept {
    return {kind.kind, hand, body, -1, -1};
  }
  /// @param record  the clip's or the cut's number in the State's buffer  @param body  that it is on; none: dropped
  static Event recorded(KindWith<Content::record> kind, int hand, int record, BodyId body) noexcept {
    return {kind.kind, hand, body, record, -1};
  }
  /// @param instrument  the new instrument's number in the hand's rack
  static Event exchange(int hand, int instrument) noexcept { return {exchanged, hand, {}, -1, instrument}; }

  Kind kind = none;
  std::int32_t hand = -1;        ///< that did it; -1: no hand caused it (torn, thread_broken, loops)
  BodyId body;                   ///< that it happened to; of injected the organ that a needle is about to fill
  std::int32_t record = -1;      ///< a clip's or a cut's number in the State's buffer
  std::int32_t instrument = -1;  ///< a number in the hand's rack

 private:
  Event(Kind k, int h, BodyId b, int r, int i) noexcept : kind(k), hand(h), body(b), record(r), instrument(i) {}
};

/// A kind of event in words. A new kind of event is one line above and one here.
struct EventWords {
  /// Without which it never happens: jaws that grip, a rack of several instruments, current, an injection needle, a
  /// sling, a thread, a clip applier.
  enum Needs { nothing, grip, choice, current, needle, sling, thread, applier };

  Event::Kind kind;
  const char* name;     ///< as lists of what happened have it
  const char* text;     ///< of it: {tool}, its trocar as {hand}, {body}
  const char* meaning;  ///< of the exercise event of that name; null: training/events looks at it more closely
  bool has_body = false;
  Needs needs = nothing;
};
inline constexpr EventWords kEventWords[] = {
    {Event::grasped, "grasped", "{tool} grasped {body}", "Jaws grasped a body.", true, EventWords::grip},
    {Event::released, "released", "{tool} released", "A hand released the grasped body.", false, EventWords::grip},
    {Event::slipped, "slipped", "{tool} slipped", "A grasp slipped off.", false, EventWords::grip},
    {Event::clipped, "clipped", "clip on {body}", nullptr, true},
    {Event::dropped_clip, "clip-dropped", "a clip closed on nothing", nullptr},
    {Event::cut, "cut", "{tool} cut {body}", nullptr, true},
    {Event::exchanged, "exchanged", "{hand}: {tool}", "Another instrument was inserted through a port.", false,
     EventWords::choice},
    {Event::torn, "torn", "{body} tore", nullptr, true},
    {Event::parted, "parted", "{tool} parted {body}", "Current divided a body.", true, EventWords::current},
    {Event::declared, "declared", "declared",
     "The trainee declared by key or pedal that the required target is shown."},
    {Event::pierced, "pierced", "{tool} pierced {body}", "A needle pierced an organ.", true, EventWords::needle},
    {Event::injected, "injected", "{tool} injects into {body}", nullptr, true},
    {Event::loop_tightened, "loop_tightened", "{tool} closed a loop on {body}",
     "A ligature loop was closed tightly enough to close the lumen inside it.", true, EventWords::sling},
    {Event::loop_loosened, "loop_loosened", "a loop on {body} loosened", "A ligature loop no longer closes the lumen.",
     true, EventWords::sling},
    {Event::loop_slipped, "loop_slipped", "a loop slipped off {body}", "A closed ligature loop slipped off an end.",
     true, EventWords::sling},
    {Event::loop_cut, "loop_cut", "a loop cut through {body}", "A ligature loop that was closed too hard cut through.",
     true, EventWords::sling},
    {Event::thread_cut, "thread_cut", "{tool} cut {body}", "Blades cut a thread.", true, EventWords::thread},
    {Event::thread_broken, "thread_broken", "{body} broke",
     "A thread broke under a hand's pull, or was crushed between instruments.", true, EventWords::thread},
    {Event::clip_blocked, "clip_blocked", "{tool} cannot close: a clip lies between its jaws",
     "A clip applier could not close because a clip lies between its jaws.", false, EventWords::applier},
};
/// Of a kind that is not Event::none.
constexpr const EventWords& words_of(Event::Kind kind) noexcept { return kEventWords[std::size_t(kind) - 1]; }
static_assert(std::all_of(std::begin(kEventWords), std::end(kEventWords), [](const EventWords& e) {
  const Event::Content content = Event::content_of(e.kind);
  return &words_of(e.kind) == &e &&
         (content == Event::Content::body ? e.has_body : content == Event::Content::record || !e.has_body);
}));
inline constexpr int kMaxEvents = 24, kRoomForTears = 8;  ///< all; of those, only for tears

/// Report of a tick. Flags of tissue::StepReport keep their meaning; the others are the step's own.
struct StepReport {
  enum Flag : std::uint32_t {
    kTooManyLoads = 1u << 16,  ///< contacts did not fit the reserved capacity: some were left out this tick
    kBadInput =
        1u << 17,  ///< an input was not finite (that hand stayed), or its instrument not in the rack (not exchanged)
    kRecordsFull = 1u << 18,  ///< a record found no room (clips, cuts, openings, seals, stitches, an organ's own for
                              ///< cuts): clips are lost, blades no longer cut, tears open no further
    kBloodFlow = 1u << 19,    ///< blood flow found no solution and was not advanced; restore a State
    kHeatFull = 1u << 22,     ///< no room for more heated tissue: raise "bricks" or "awake" of the scene's energy
    kEventsFull = 1u << 21,   ///< more happened in a tick than a report holds: some events are missing
    kDropsFull = 1u << 20,    ///< no room for more drops of fluid: what flowed went straight into the pool
  };
  std::uint32_t flags = 0;
  BodyId first_bad_body;
  int first_bad_index = -1;  ///< node of that body
  Event events[kMaxEvents];
  int event_count = 0;

  bool fine() const { return (flags & (tissue::StepReport::kNonFinite | tissue::StepReport::kIndefinite)) == 0; }
};

}  // namespace trocar::sim
