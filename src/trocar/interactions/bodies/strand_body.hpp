// A strand with what surgery needs to know of it: arc length, contact radius, lumen, its clips and cuts.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/core/body_id.hpp>
#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/tissue/strand/strand.hpp>

namespace trocar::interactions {

/// Const after compile.
struct StrandBody {
  tissue::StrandModel model;
  std::vector<double> arc;  ///< (n) drawn arc length from the start [m]
  bool cuttable = true;

  int nodes() const { return model.nodes; }
  double length() const { return arc.back(); }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("model", s.model), v("arc", s.arc), v("cuttable", s.cuttable);
  }
};

/// A material point: element and place within it.
struct StrandPlace {
  int element = 0;
  double w = 0;  ///< 0..1

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("element", s.element), v("w", s.w);
  }
};
StrandPlace place_at(const StrandBody& body, double s) noexcept;
double arc_at(const StrandBody& body, StrandPlace place) noexcept;
/// Position; within a cut element each side continues straight from its own stump.
Vec3d point_at(const StrandBody& body, const tissue::StrandState& state, StrandPlace place) noexcept;
Vec3d tangent_at(const StrandBody& body, const tissue::StrandState& state, StrandPlace place) noexcept;

/// Direction and two normals at a node, transported from the start without twisting (by smallest rotations).
struct StrandFrame {
  Vec3d tangent, normal, binormal;
};
/// The frame of the element that `place` lies in.
StrandFrame frame_at(const StrandBody& body, const tissue::StrandState& state, StrandPlace place) noexcept;
/// Frames of all elements. @param frames (n - 1)
void frames_of(const StrandBody& body, const tissue::StrandState& state, StrandFrame* frames) noexcept;

inline constexpr int kMaxClips = 32, kMaxCuts = 128;

/// A clip is a record on its host: it closes the lumen and rides on the strand's frame. No padding.
struct Clip {
  double s = 0;                   ///< arc length on the host [m]
  double theta = 0;               ///< jaw-plane normal against the tube's direction [rad], 0 = perpendicular clip
  double cover = 0;               ///< share of the cross-section between the legs, 0..1
  double closing_time = 0;        ///< from half open to closed [s]
  double opening[3] = {0, 0, 0};  ///< legs' opening direction in the host's (tangent, normal, binormal)
  double axis[3] = {0, 0, 0};     ///< legs' direction, the same
  double reach = 0;               ///< from the legs' bend to the strand's centre, along the axis [m]
  double length = 0;              ///< of its legs [m]
  std::uint64_t tick = 0;
  std::int32_t strand = -1;  ///< -1: on a vessel or a thread, or dropped
  std::int32_t tool = 0;
  std::int32_t tips_visible = 0;  ///< jaw tips in view when it closed, 0..2
  std::int32_t vessel = 0;  ///< above 0: no strand lay between the legs, but this vessel + 1; s, axes are on it. Below
                            ///< 0: neither, but the thread of the suture -vessel - 1, which knows where it is now

  bool dropped() const noexcept { return strand < 0 && vessel == 0; }
  bool on_thread() const noexcept { return strand < 0 && vessel < 0; }
  std::int32_t suture() const noexcept { return -vessel - 1; }
  /// The strand or the suture that it is on.
  BodyId body() const noexcept {
    return on_thread() ? BodyId::maybe(BodyKind::suture, suture()) : BodyId::maybe(BodyKind::strand, strand);
  }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("s", s.s), v("theta", s.theta), v("cover", s.cover), v("closing_time", s.closing_time), v("opening", s.opening),
        v("axis", s.axis), v("reach", s.reach), v("length", s.length), v("tick", s.tick), v("strand", s.strand),
        v("tool", s.tool), v("tips_visible", s.tips_visible), v("vessel", s.vessel);
  }
};
static_assert(sizeof(Clip) == 12 * 8 + 8 + 4 * 4, "no padding");

/// What scissors did to a strand, or (strand -1) to an organ or a fold. No padding.
struct Cut {
  double s = 0;
  double fraction = 0;  ///< of the cross-section, 1 = through
  double beyond = 0;    ///< how far the blades reached past the strand [m]
  double fold = 0;      ///< how deep the blades went into a membrane: from its strand's surface, in the drawn shape [m]
  std::uint64_t tick = 0;
  std::int32_t strand = -1;
  std::int32_t tool = 0;
  std::int32_t tips_visible = 0;
  std::int32_t solid = -1;     ///< organ whose springs and skin the blades parted
  std::int32_t membrane = -1;  ///< fold that the blades parted, alone or with its strand
  std::int32_t reserved = 0;

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("s", s.s), v("fraction", s.fraction), v("beyond", s.beyond), v("fold", s.fold), v("tick", s.tick),
        v("strand", s.strand), v("tool", s.tool), v("tips_visible", s.tips_visible), v("solid", s.solid),
        v("membrane", s.membrane), v("reserved", s.reserved);
  }

  /// What was cut: a strand before the fold that it carries.
  BodyId body() const noexcept {
    if (strand >= 0) return BodyId::strand(std::size_t(strand));
    return solid >= 0 ? BodyId::organ(std::size_t(solid)) : BodyId::maybe(BodyKind::membrane, membrane);
  }
};
static_assert(sizeof(Cut) == 4 * 8 + 8 + 6 * 4, "no padding");

void add_to_hash(core::Hasher& hasher, const StrandBody& body) noexcept;

}  // namespace trocar::interactions
