// All that a replay needs, and nothing else: flat arrays, copyable, hashable, saved and restored at any tick.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/states.hpp>
#include <trocar/interactions/instrument/membrane_contact.hpp>
#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/interactions/verbs/vessel_tools.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::sim {

/// What the valves of a hand's suction-irrigator do in a tick: bits of State::valves.
enum Valve : std::uint8_t {
  kIrrigates = 1,
  kSucks = 2,
  kPlugged = 4,   ///< sucks, but tissue lies on the port: nothing flows
  kSucksGas = 8,  ///< there is less liquid than it could take
};
/// What a hand's electrode is and was at. No padding.
struct ElectrodeHand {
  tissue::ElectrodeState current;
  Vec3d at{0, 0, 0};             ///< the tissue's point that it was last at [m]
  Vec3d a{0, 0, 0}, b{0, 0, 0};  ///< ends of what touched there, in that body's frame of heat [m]
  Vec3d parted{0, 0, 0};         ///< where it last parted tissue, in that body's frame of heat [m]
  BodyId body, parted_body;
  std::int32_t changes = 0;  ///< ToolState::changes of the instrument that this is
  interactions::Hold stuck;  ///< what sticks to it; no body: nothing

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("current", s.current), v("at", s.at), v("a", s.a), v("b", s.b), v("parted", s.parted), v("body", s.body),
        v("parted_body", s.parted_body), v("changes", s.changes), v("stuck", s.stuck);
  }
};
static_assert(sizeof(ElectrodeHand) == sizeof(tissue::ElectrodeState) + 12 * 8 + 3 * 4 + sizeof(interactions::Hold),
              "no padding");

/// A spring of a lattice or a fold that heat has changed (scarring.hpp).
struct Scar {
  BodyId body;
  std::int32_t spring = -1;  ///< of its network; of bodies that can be cut: the cell that all its springs belong to
  float share = 1;           ///< of its length that is left
  float stiff = 1;           ///< times its stiffness

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("spring", s.spring), v("share", s.share), v("stiff", s.stiff);
  }
};
inline constexpr std::int32_t kMaxScarred = 1024;

struct State : interactions::BodyStates {
  std::uint64_t tick = 0;                                   ///< ticks made
  std::vector<std::vector<interactions::BondState>> bonds;  ///< (sets of bonds)(bonds)
  interactions::ObjectStates objects;
  std::array<interactions::ToolState, kMaxTools> tools;
  std::array<std::int32_t, kMaxTools * kMaxRack> magazine{};  ///< clips in instruments that are put down, hand by hand
  ScopeInput scope;                                           ///< where the scope is
  std::array<interactions::Clip, interactions::kMaxClips> clips;
  std::array<interactions::Cut, interactions::kMaxCuts> cuts;
  std::int32_t clip_count = 0, cut_count = 0;
  std::vector<std::int32_t> nearest;  ///< contact caches: one per sample of each pair, in the Model's order
  std::vector<std::vector<std::int32_t>> carried;  ///< (carried pairs)(samples) vertex next to it, -1: none is near
  std::vector<Vec3f> strand_side;                  ///< per element of each strand pair's first strand
  std::vector<Vec3f> tool_side;  ///< (tools x elements of all strands x kToolParts; kMostParts if it bends())
  std::vector<std::vector<std::uint8_t>> parted;  ///< (solids) per triangle of the drawn skin: 1 = cut open
  std::vector<Vec3f> sheet_side;                  ///< (hands x triangles of all membranes x kSheetParts or kMostParts)
  std::vector<interactions::SheetBond> sheet_bond;  ///< (hands x membranes)
  /// For how long nodes have been stretched beyond what they bear (tissue/failure/overstretch.hpp): rows of organs and
  /// of membranes, nodes of strands; empty for bodies that never tear.
  std::vector<std::vector<std::uint8_t>> overstretched_organs, overstretched_membranes, overstretched_strands;
  std::vector<kinematics::Joints> joints;        ///< (hands) where instruments bend; empty where none of them can
  std::vector<kinematics::PortState> ports;      ///< (hands) where fulcra are; empty where all are rigid
  std::vector<interactions::TouchBook> touches;  ///< (hands) what instruments were near and where it sticks to them
  /// Blood, and what opens and closes its vessels; all empty in scenes without vessels.
  vessels::FlowState flow;
  std::vector<interactions::VesselOpening> openings;   ///< (kMaxOpenings)
  std::vector<interactions::VesselClip> vessel_clips;  ///< (kMaxVesselClips)
  std::int32_t opening_count = 0, vessel_clip_count = 0;
  /// Heat, electrodes and what they seal; all empty in scenes without energy.
  tissue::HeatState heat;
  tissue::GeneratorPanel panel;
  std::vector<ElectrodeHand> electrodes;        ///< (hands)
  std::vector<interactions::VesselSeal> seals;  ///< (kMaxSeals)
  std::int32_t seal_count = 0;
  std::vector<Scar> scarred;  ///< (kMaxScarred)
  std::int32_t scarred_count = 0;
  fluids::FluidsState fluids;     ///< empty in scenes without fluids
  std::vector<float> pool_floor;  ///< of the pool, (ny x nx) [m]; walls and organs
  /// What drops gave to tissue in the last tick: it goes to the bodies in the next. Empty without a suction-irrigator.
  std::vector<fluids::Impact> impacts;  ///< (drops' capacity) the first `impact_count`
  std::int32_t impact_count = 0;
  std::array<std::uint8_t, kMaxTools> valves{};  ///< (hands) Valve, in the last tick
  std::vector<std::uint8_t> seen;                ///< (samples) 1 = in view when last looked
  InjectionState injection;                      ///< empty without an injection needle
  std::uint8_t declaring = 0;                    ///< kDeclare was down in the last tick

  template <class S, class V>
  static void fields(S& s, V&& v) {
    // Parts that a scene may lack are hashed where it has them.
    const bool bleeds = !s.openings.empty(), heats = !s.electrodes.empty();
    const bool wet = !s.fluids.droplets.x.empty(), irrigates = !s.impacts.empty();
    v("tick", s.tick), v("solids", s.solids), v("cuttables", s.cuttables), v("strands", s.strands), v("tools", s.tools),
        v("magazine", s.magazine), v("scope", s.scope), v("clips", s.clips), v("cuts", s.cuts),
        v("clip_count", s.clip_count), v("cut_count", s.cut_count), v("nearest", s.nearest),
        v("carried", s.carried, core::only_if(!s.carried.empty())), v("strand_side", s.strand_side),
        v("tool_side", s.tool_side), v("touches", s.touches), v("seen", s.seen), v("membranes", s.membranes),
        v("fat", s.fat, core::only_if(!s.fat.empty())), v("sheet_side", s.sheet_side), v("sheet_bond", s.sheet_bond),
        v("overstretched_organs", s.overstretched_organs), v("overstretched_membranes", s.overstretched_membranes),
        v("overstretched_strands", s.overstretched_strands), v("torn", s.torn), v("parted", s.parted),
        v("flow", s.flow, core::only_if(bleeds)), v("openings", s.openings, core::only_if(bleeds)),
        v("vessel_clips", s.vessel_clips, core::only_if(bleeds)),
        v("opening_count", s.opening_count, core::only_if(bleeds)),
        v("vessel_clip_count", s.vessel_clip_count, core::only_if(bleeds)), v("heat", s.heat, core::only_if(heats)),
        v("panel", s.panel, core::only_if(heats)), v("electrodes", s.electrodes, core::only_if(heats)),
        v("seals", s.seals, core::only_if(heats)), v("seal_count", s.seal_count, core::only_if(heats)),
        v("scarred_count", s.scarred_count, core::only_if(heats)),
        v("scarred", s.scarred, core::FieldNote{.hashed = heats, .first = s.scarred_count}),
        v("fluids", s.fluids, core::only_if(wet)), v("pool_floor", s.pool_floor, core::only_if(wet)),
        v("valves", s.valves, core::only_if(irrigates)), v("impact_count", s.impact_count, core::only_if(irrigates)),
        v("impacts", s.impacts, core::FieldNote{.hashed = irrigates, .first = s.impact_count}), v("objects", s.objects),
        v("statics", s.statics, core::only_if(!s.statics.empty())),
        v("bonds", s.bonds, core::only_if(!s.bonds.empty())),
        v("injection", s.injection, core::only_if(s.injection.there())),
        v("declaring", s.declaring, core::only_if(s.declaring != 0)),
        v("joints", s.joints, core::only_if(!s.joints.empty())), v("ports", s.ports, core::only_if(!s.ports.empty()));
  }
};

State initial_state(const Model& model);
/// Bodies in their drawn shape and nothing else: for compile, before the Model is complete.
State drawn_bodies(const Model& model);

/// How a hand's instrument is bent now; straight where none bends.
kinematics::Joints joints_of(const State& state, size_t hand) noexcept;
/// How far a trocar's fulcrum is from its place now, and where it is [m].
Vec3d port_shift(const State& state, size_t hand) noexcept;
Vec3d port_of(const Model& model, const State& state, size_t hand) noexcept;
/// A commanded pose, which is about the port's place, as a pose about the fulcrum as it is: the handle is the hand's.
kinematics::FulcrumPose held_pose(const Model& model, const State& state, size_t hand,
                                  const kinematics::FulcrumPose& pose) noexcept;
/// A hand's instrument as it is now.
interactions::ToolShape shape_of(const Model& model, const State& state, size_t hand) noexcept;
/// The tip of its closed jaws, without the rest.
kinematics::TipFrame tip_frame_of(const Model& model, const State& state, size_t hand) noexcept;

/// The place that a hand controls: the straight instrument's tip, of a redundant one the tip that it has.
Vec3d led_place(const Model& model, const State& state, size_t hand) noexcept;

/// Where an organ's nodes are: valid until its next tick.
tissue::NodeView nodes_of(const Model& model, const State& state, int organ) noexcept;

/// 64-bit hash of all of it.
std::uint64_t hash_of(const State& state) noexcept;

/// The first field in which two States of one Model differ, and both values: "solids[2].nodes[17].vx: 0.25 and 0.5".
/// Empty where none does.
std::string first_difference(const State& a, const State& b);

}  // namespace trocar::sim
