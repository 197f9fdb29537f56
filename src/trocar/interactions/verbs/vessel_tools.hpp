// What instruments do to vessels: blades and tears open them, clips close them. Both leave a record at a material place
// of the vessel; blood flow (vessels/flow.hpp) reads the records.
#pragma once

#include <cstdint>

#include <trocar/core/fields.hpp>
#include <trocar/geometry/tets/blade.hpp>
#include <trocar/interactions/couplings/vessel_path.hpp>
#include <trocar/interactions/instrument/tool.hpp>

namespace trocar::interactions {

inline constexpr int kMaxSeals = 32;
inline constexpr int kMaxOpenings = 30, kMaxVesselClips = 64;  ///< two sides each fit fluids::kMostOpenings

/// Where blood gets out. No padding.
struct VesselOpening {
  double s = 0;     ///< 0 .. 1 along the vessel
  double area = 0;  ///< [m^2]; of each stump where it is cut through
  std::uint64_t tick = 0;
  std::int32_t vessel = -1;
  std::int32_t through = 0;  ///< 1: cut through, two stumps; 0: a hole
  std::int32_t tool = -1;    ///< the hand that cut; -1: it tore
  std::int32_t reserved = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("s", s.s), v("area", s.area), v("tick", s.tick), v("vessel", s.vessel), v("through", s.through),
        v("tool", s.tool), v("reserved", s.reserved);
  }
};
static_assert(sizeof(VesselOpening) == 3 * 8 + 4 * 4, "no padding");

/// What a clip does to a vessel between its legs. No padding.
struct VesselClip {
  double s = 0;
  double cover = 0;  ///< share of the vessel's width between the legs, when closed
  std::uint64_t tick = 0;
  std::int32_t vessel = -1;
  std::int32_t clip = -1;  ///< number in the clip buffer

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("s", s.s), v("cover", s.cover), v("tick", s.tick), v("vessel", s.vessel), v("clip", s.clip);
  }
};
static_assert(sizeof(VesselClip) == 3 * 8 + 2 * 4, "no padding");

/// A stretch of a vessel that heat seals, or begins to. No padding.
struct VesselSeal {
  double from = 0, to = 0;  ///< 0 .. 1 along the vessel; of a stump one place, a little way behind its end
  tissue::SealState state;
  std::uint64_t tick = 0;  ///< when it was last heated
  std::int32_t vessel = -1;
  std::int32_t opening = -1;  ///< the hole that it closes, else -1

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("from", s.from), v("to", s.to), v("state", s.state), v("tick", s.tick), v("vessel", s.vessel),
        v("opening", s.opening);
  }
};
static_assert(sizeof(VesselSeal) == 5 * 8 + 2 * 4, "no padding");

/// Bears three times a systolic pressure of 120 mmHg: what practice asks of a seal. What bears less lets blood pass.
inline constexpr double kSealBears = 48e3;  ///< [Pa]
inline bool holds(const VesselSeal& seal) noexcept {
  return tissue::burst_pressure(tissue::SealDescription{}, seal.state) >= kSealBears;
}

/// Titanium legs close in this time; what they close narrows as fast.                                  [s]  Our choice
inline constexpr double kClipCloses = 0.3;
/// Cover of a clip that was set `age` seconds ago.
inline double cover_at(const VesselClip& clip, double age) noexcept {
  return age >= kClipCloses ? clip.cover : clip.cover * (age / kClipCloses);
}

/// What a blade does to a piece of a vessel: where, and which share of its width (1: through; 0: it misses).
struct VesselWound {
  double s = 0, share = 0;
};
VesselWound wound_of(const geometry::BladePlane& plane, const VesselPiece& piece, double radius) noexcept;

/// A vessel between the legs of a clip.
struct VesselCatch {
  double s = 0, cover = 0;
  Vec3d local;  ///< where it passes, in the jaw frame [m]
};
/// @return false where the piece does not lie between the legs
bool catch_vessel(const ToolModel& model, const ToolShape& shape, const VesselPiece& piece, double radius,
                  VesselCatch& found) noexcept;

/// Notes how a clip lies on a vessel that is all there is between its legs.
void put_on_vessel(const ToolModel& model, const ToolShape& shape, const VesselPath& path, const VesselSpot& spot,
                   int vessel, const VesselCatch& found, Clip& clip) noexcept;

}  // namespace trocar::interactions
