// What needles inject: where each point is, what it has given and taken, what lies in organs, and the account of it.
//
//   injected = in the tissue + taken up by vessels + leaked + injected into vessels + spilled    [injection account]
//
// to the picolitre, at every tick. What leaks and spills passes into the fluids' account, where a scene has fluids.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/verbs/pierce.hpp>
#include <trocar/tissue/infusion/infusion.hpp>

namespace trocar::sim {

/// What of an organ needles have to do with.
struct PiercedOrgan {
  double puncture = 0;             ///< force at which its skin gives way [N]; 0: no needle gets in
  tissue::InfusionModel infusion;  ///< of lattices; others take nothing up

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("puncture", s.puncture), v("infusion", s.infusion);
  }
};

struct InjectionModel {
  std::vector<PiercedOrgan> organs;

  bool there() const noexcept { return !organs.empty(); }
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("organs", s.organs);
  }
};

/// A hand's needle and its syringe. No padding.
struct NeedleHand {
  interactions::MaterialPoint entry;  ///< where its point has gone in; body none: it is in nothing
  interactions::MaterialPoint touch;  ///< what its point has caught and not pierced; body none: nothing
  Vec3d at{0, 0, 0};                  ///< the point [m]
  double anchor = 0;                  ///< interactions::carry_skin [m]
  double depth = 0;                   ///< of the point below the nearest skin [m]
  double press = 0;                   ///< on a skin that it has not pierced [N]
  double rate = 0;                    ///< flow that the thumb has come to [m^3/s]
  double flow = 0;                    ///< out of the needle in the last tick [m^3/s]
  double tip_pressure = 0;            ///< [Pa]
  double plunger = 0;                 ///< force on the plunger, pulling below 0 [N]
  double carry = 0;                   ///< [pL] below a whole one
  double carry_drawn = 0;             ///< [pL] the same of blood
  double drawn_for = 0;               ///< the plunger has been drawn at this place for so long [s]
  Vec3d checked{0, 0, 0};             ///< where the point was then [m]
  std::int64_t left = 0;              ///< in the syringe [pL]
  std::int64_t pending = 0;           ///< has flowed into the body and is not shared out yet [pL]
  std::int64_t here = 0;              ///< injected since the point went in [pL]
  std::int64_t blood = 0;             ///< drawn since the point went in [pL]
  std::int32_t vessel = -1;           ///< that its point is in
  std::int32_t pushing = 0;           ///< 1: it was injecting in the last tick
  std::int32_t punctures = 0;         ///< punctures so far
  std::int32_t changes = 0;           ///< ToolState::changes of the instrument that this is

  bool in() const noexcept { return entry.body.exists(); }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("entry", s.entry), v("touch", s.touch), v("at", s.at), v("anchor", s.anchor), v("depth", s.depth),
        v("press", s.press), v("rate", s.rate), v("flow", s.flow), v("tip_pressure", s.tip_pressure),
        v("plunger", s.plunger), v("carry", s.carry), v("carry_drawn", s.carry_drawn), v("drawn_for", s.drawn_for),
        v("checked", s.checked), v("left", s.left), v("pending", s.pending), v("here", s.here), v("blood", s.blood),
        v("vessel", s.vessel), v("pushing", s.pushing), v("punctures", s.punctures), v("changes", s.changes);
  }
};
static_assert(sizeof(NeedleHand) == 2 * sizeof(interactions::MaterialPoint) + 3 * 8 + 10 * 8 + 3 * 8 + 4 * 8 + 4 * 4,
              "no padding");

/// A way that a needle has left. No padding.
struct NeedleTrack {
  interactions::MaterialPoint at;
  std::int32_t reserved = 0;
  std::uint64_t tick = 0;   ///< when it was drawn out
  double carry = 0;         ///< [pL] below a whole one
  std::int64_t leaked = 0;  ///< so far [pL]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("at", s.at), v("reserved", s.reserved), v("tick", s.tick), v("carry", s.carry), v("leaked", s.leaked);
  }
};
static_assert(sizeof(NeedleTrack) == sizeof(interactions::MaterialPoint) + 4 + 3 * 8, "no padding");
inline constexpr std::int32_t kMaxTracks = 16;  ///< the oldest is closed when there are more

/// [pL] since the beginning.
struct InjectionAccount {
  std::int64_t injected = 0;  ///< out of needles
  std::int64_t absorbed = 0;  ///< out of the tissue into vessels
  std::int64_t leaked = 0;    ///< back along needles and their ways, and out of tears
  std::int64_t vessel = 0;    ///< straight into vessels
  std::int64_t spilled = 0;   ///< into the open
  std::int64_t drugged = 0;   ///< of `injected`: with a drug

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("injected", s.injected), v("absorbed", s.absorbed), v("leaked", s.leaked), v("vessel", s.vessel),
        v("spilled", s.spilled), v("drugged", s.drugged);
  }
};

/// All empty in scenes without an injection needle.
struct InjectionState {
  std::vector<NeedleHand> hands;              ///< (hands)
  std::vector<tissue::InfusionState> organs;  ///< (organs) empty ones where nothing is taken up
  std::vector<std::int64_t> given;            ///< (organs) that has found room in each [pL]
  std::vector<double> fills;        ///< (hands) how the tissue around a needle's point resists, as it is filled
                                    ///< [Pa s/m^3]
  std::vector<NeedleTrack> tracks;  ///< (kMaxTracks)
  std::int32_t track_count = 0;
  std::int32_t reserved = 0;
  InjectionAccount account;

  bool there() const noexcept { return !hands.empty(); }
  /// Of any hand.
  bool resists() const noexcept {
    return std::any_of(fills.begin(), fills.end(), [](double r) { return r > 0; });
  }
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("hands", s.hands), v("organs", s.organs), v("given", s.given), v("fills", s.fills, core::only_if(s.resists())),
        v("track_count", s.track_count), v("tracks", s.tracks, core::FieldNote{.first = s.track_count}),
        v("account", s.account), v("reserved", s.reserved, core::kNotHashed);
  }
};

/// In the tissue now, pending included.                                                                  [pL]
inline std::int64_t in_tissue(const InjectionState& s) noexcept {
  std::int64_t sum = 0;
  for (const tissue::InfusionState& organ : s.organs) sum += organ.total;
  for (const NeedleHand& hand : s.hands) sum += hand.pending;
  return sum;
}
/// [injection account]
inline bool balanced(const InjectionState& s) noexcept {
  const InjectionAccount& a = s.account;
  return a.injected == in_tissue(s) + a.absorbed + a.leaked + a.vessel + a.spilled;
}

}  // namespace trocar::sim
