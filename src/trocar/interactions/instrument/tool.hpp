// An instrument in the body: its shape (shaft and two jaws as capsules), its pose through the trocar, and the space
// between its jaws, in which it grips, clips or cuts. A hook with a foot has no jaws: in their place stand its wire and
// the foot that this ends in, which do not open.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <trocar/collision/rods.hpp>
#include <trocar/core/body_id.hpp>
#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/interactions/instrument/linkage.hpp>
#include <trocar/interactions/instrument/syringe.hpp>
#include <trocar/interactions/instrument/tool_kind.hpp>
#include <trocar/kinematics/articulation.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/kinematics/port.hpp>
#include <trocar/tissue/heat/electrosurgery.hpp>
#include <trocar/tissue/heat/electrosurgery_seal.hpp>

namespace trocar::interactions {

/// What current leaves from: a hook's wire, the pads of bipolar jaws.
struct ElectrodeModel {
  bool there = false;
  tissue::ElectrodeDescription current;
  tissue::SealDescription seal;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("current", s.current), v("seal", s.seal), v("there", s.there, core::kNotHashed);
  }
};

struct LinkageWorks;  // linkage_works.hpp

struct ToolModel {
  std::string name;
  ToolKind kind = ToolKind::probe;
  Vec3d port;
  kinematics::FulcrumLimits limits;
  double shaft_radius = 0.0025, shaft_length = 0.310;                    ///< [m]
  double jaw_length = 0.020, jaw_width = 0.003, jaw_thickness = 0.0015;  ///< [m]
  double opening = 1.0;                                                  ///< full angle between the open jaws [rad]
  double parallel_gap = 0;  ///< > 0: parallel jaws with this gap when open [m]
  double foot = 0;          ///< > 0: of a hook, how far it reaches from the wire's axis, to where jaws would open [m]
  double pinch_max = 15;    ///< force between the jaws, handle closed on tissue [N]
  double friction = 1.67;   ///< pull borne per pinch
  /// Coulomb's coefficient of shaft and jaws on tissue. Polished steel on wet tissue: 0.05 to 0.2 in the literature;
  /// the figure is our choice.
  double rubbing = 0.1;
  double clip_length = 0;  ///< [m]
  std::int32_t clips = 0;  ///< in the magazine at the start
  ElectrodeModel electrode;
  NeedleModel needle;                         ///< that comes out of the blunt end of an injection needle
  LinkageModel linkage;                       ///< between handle and jaws, where the file names a mechanism
  std::shared_ptr<const LinkageWorks> works;  ///< of that what is drawn; null: nothing
  kinematics::Articulation bends;             ///< a wrist, or more; without joints the instrument is rigid

  const Abilities& can() const noexcept { return about(kind).can; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("kind", s.kind), v("port", s.port), v("limits", s.limits), v("shaft_radius", s.shaft_radius),
        v("shaft_length", s.shaft_length), v("jaw_length", s.jaw_length), v("jaw_width", s.jaw_width),
        v("jaw_thickness", s.jaw_thickness), v("opening", s.opening), v("parallel_gap", s.parallel_gap),
        v("pinch_max", s.pinch_max), v("friction", s.friction), v("rubbing", s.rubbing),
        v("clip_length", s.clip_length), v("clips", s.clips), v("foot", s.foot, core::only_if(s.foot > 0)),
        v("electrode", s.electrode, core::only_if(s.electrode.there)),
        v("needle", s.needle, core::only_if(s.needle.there)), v("linkage", s.linkage, core::only_if(s.linkage.there)),
        v("bends", s.bends, core::only_if(s.bends.bends())), v("name", s.name, core::kNotHashed),
        v("works", s.works, core::kNotHashed);
  }
};

inline constexpr int kMaxHolds = 12;  ///< tissue points between one pair of jaws

/// A point held between the jaws, and where in the jaw frame (opening, normal, axis from the pivot).
struct Hold {
  MaterialPoint at;
  float local[3] = {0, 0, 0};  ///< [m]
  float force[3] = {0, 0, 0};  ///< of this point on the tissue in the last tick [N]

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("at", s.at), v("local", s.local), v("force", s.force);
  }
};

/// State of one instrument. Plain old data without padding: hashed and saved as bytes.
struct ToolState {
  double yaw = 0, pitch = 0, roll = 0, depth = 0;  ///< where it is (follows the input, bounded in speed)
  double aperture = 1;                             ///< 1 open .. 0 closed; tissue between the jaws keeps it open
  double handle = 0;                               ///< where the handle is
  double pinch = 0;                                ///< force between the jaws [N]
  double contact_force[3] = {0, 0, 0};             ///< of the tissue on the instrument, last tick [N]
  double pull[3] = {0, 0, 0};                      ///< of the held tissue on the jaws, last tick [N]
  double closed_for = 0;                           ///< how long the jaws took from half to fully closed so far [s]
  std::int32_t clips_left = 0;
  std::int16_t armed = 0;  ///< above 0: jaws have been open since the last clip or cut, so wide; below: see cut.hpp;
                           ///< of clip appliers 2: clips keep the jaws apart since then
  std::int16_t letting_go = 0;  ///< a grip is loose because the hand has opened it
  std::int32_t holds = 0;       ///< used entries of hold[]
  std::int32_t slipped = 0;     ///< slips so far
  std::int32_t instrument = 0;  ///< which of the hand's rack this is
  std::int32_t changes = 0;     ///< instruments changed so far
  Hold hold[kMaxHolds];

  kinematics::FulcrumPose pose() const { return {yaw, pitch, roll, depth}; }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("yaw", s.yaw), v("pitch", s.pitch), v("roll", s.roll), v("depth", s.depth), v("aperture", s.aperture),
        v("handle", s.handle), v("pinch", s.pinch), v("contact_force", s.contact_force), v("pull", s.pull),
        v("closed_for", s.closed_for), v("clips_left", s.clips_left), v("armed", s.armed),
        v("letting_go", s.letting_go), v("holds", s.holds), v("slipped", s.slipped), v("instrument", s.instrument),
        v("changes", s.changes), v("hold", s.hold);
  }
};
static_assert(sizeof(ToolState) == 14 * 8 + 6 * 4 + kMaxHolds * sizeof(Hold), "no padding");

using collision::Capsule;

/// Of a hook with a foot kJawA is the wire and kJawB the foot, from the wire's end on.
inline constexpr int kShaft = 0, kJawA = 1, kJawB = 2, kToolParts = 3;
/// For folds, too, both jaws together: closed ones are a blunt rod, and nothing gets between them. Not wire and foot.
inline constexpr int kBothJaws = kToolParts, kSheetParts = kToolParts + 1;
/// Beyond these what bends between shaft and jaws, piece by piece.
inline constexpr int kFirstLink = kSheetParts, kMostParts = kFirstLink + kinematics::kMaxLinks;
constexpr bool is_jaw(int part) noexcept { return part != kShaft && part < kFirstLink; }

/// Where an instrument is in space this tick.
struct ToolShape {
  kinematics::TipFrame frame;  ///< tip of the closed jaws
  Vec3d pivot;                 ///< where the jaws hinge
  kinematics::TipFrame shaft;  ///< the shaft's end, from where on it bends; of a rigid instrument the jaws' hinge
  Capsule part[kToolParts];
  Vec3d velocity[kToolParts];  ///< of each part's far end [m/s]
  Capsule link[kinematics::kMaxLinks];
  int links = 0;
  double half_angle = 0;  ///< of each jaw from the axis [rad]
  double half_gap = 0;    ///< at the pivot (parallel jaws) [m]
  double needle_in = 0;   ///< how far an injection needle is drawn in [m]
  bool has_foot = false;  ///< it is a hook's, and has no jaws
  bool spreads = false;   ///< its jaws push apart what lies beside them

  /// Half the clear distance between the jaws at `along` [m] from the pivot.
  double half_opening(double along) const { return half_gap + along * tangent; }
  double tangent = 0;  ///< of half_angle

  /// Shaft, jaw, or from kFirstLink on a link.
  const Capsule& rod(int number) const noexcept {
    return number < kToolParts ? part[number] : link[number - kFirstLink];
  }
};

/// The next number of a part that the instrument has, after shaft and jaws its links:
/// for (int part = kShaft; part < end_of(shape); part = next(part))
inline int end_of(const ToolShape& shape) noexcept { return kFirstLink + shape.links; }
constexpr int next(int part) noexcept { return part + 1 == kToolParts ? kFirstLink : part + 1; }

/// Shape at `pose` and `aperture`, straight or as its joints bend it; the velocity is left zero. About the trocar's
/// place, or `shift` beside it.
ToolShape shape_of(const ToolModel& model, const kinematics::FulcrumPose& pose, double aperture) noexcept;
ToolShape shape_of(const ToolModel& model, const kinematics::FulcrumPose& pose, const kinematics::Joints& joints,
                   double aperture, Vec3d shift = {0, 0, 0}) noexcept;

/// A point in the jaw frame: x along the opening direction, y along the jaw-plane normal, z along the axis from pivot.
Vec3d to_jaw(const ToolShape& shape, Vec3d world) noexcept;
Vec3d from_jaw(const ToolShape& shape, Vec3d local) noexcept;
Vec3d direction_from_jaw(const ToolShape& shape, Vec3d local) noexcept;

/// The aperture at which the jaws touch tissue of `thickness` lying `along` from the pivot.
double aperture_at(const ToolModel& model, double thickness, double along) noexcept;

/// How much of an instrument that is so deep is between its trocar and the hand [m].
double outside_of(const ToolModel& model, double depth) noexcept;

/// Moves the instrument towards the commanded pose, no faster than hands can: 0.6 m/s at the tip and 4 rad/s, roll 8
/// rad/s, handle 8 /s.
struct ToolCommand {
  kinematics::FulcrumPose pose;
  double handle = 0;
};
void follow(const ToolModel& model, const ToolCommand& command, double dt, ToolState& state) noexcept;

/// Where a hand that leads with pose and wrist [rad] wants an instrument that bends. The joints of a wrist are the
/// hand's own; those of a redundant chain follow from where the tip shall be and how it shall be turned, from the
/// chain's pose now. Within limits; as far as it is in its trocar's sleeve it is straight.
/// @param wrist  pitch and yaw
kinematics::Arm wanted_arm(const ToolModel& model, const kinematics::FulcrumPose& pose, const double (&wrist)[2],
                           const ToolState& state, const kinematics::Joints& joints) noexcept;
/// Joints turn by at most 6 rad/s.
void follow_joints(const kinematics::Joints& wanted, double dt, kinematics::Joints& joints) noexcept;

}  // namespace trocar::interactions
