// Everything about a scene that does not change while it runs: compiled once, const, shared by any number of States.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/fluids/fluids.hpp>
#include <trocar/geometry/volumes/cell_mask.hpp>
#include <trocar/interactions/bodies/models.hpp>
#include <trocar/interactions/contact/body_contact.hpp>
#include <trocar/interactions/contact/carried_contact.hpp>
#include <trocar/interactions/contact/self_contact.hpp>
#include <trocar/interactions/contact/skin_grid.hpp>
#include <trocar/interactions/couplings/bonds.hpp>
#include <trocar/interactions/couplings/vessel_path.hpp>
#include <trocar/interactions/instrument/tool.hpp>
#include <trocar/interactions/objects/object_kinds.hpp>
#include <trocar/sim/model/injection.hpp>
#include <trocar/sim/model/input.hpp>
#include <trocar/sim/model/mark.hpp>
#include <trocar/sim/model/motion.hpp>
#include <trocar/tissue/heat/electrosurgery.hpp>
#include <trocar/vessels/flow.hpp>

namespace trocar::sim {

using core::kTick;
using interactions::CuttableOrgan;
using interactions::LandmarkModel;
using interactions::MembraneBody;
using interactions::SolidModel;
using interactions::StaticOrgan;
using interactions::StaticOrganState;
using interactions::StrandAnatomy;
using interactions::StrandEndModel;

struct MaterialLibrary;

struct WallModel {
  std::string name, look;
  tissue::Skin skin;  ///< weights unused
  tissue::SkinPose pose;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("skin", s.skin), v("name", s.name, core::kNotHashed), v("look", s.look, core::kNotHashed),
        v("pose", s.pose, core::kNotHashed);
  }
};

/// A thin fold, drawn between a strand and its base; mechanically it is the strand's foundation.
struct DrawnFold {
  std::string name, look;
  std::int32_t strand = -1;
  double from = 0, to = 0;                        ///< arc length [m]
  std::vector<interactions::MaterialPoint> base;  ///< its other border

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("name", s.name), v("look", s.look), v("strand", s.strand), v("from", s.from), v("to", s.to), v("base", s.base);
  }
};

/// An artery or a vein: the flow's segment of the same number, and where it runs.
struct Vessel {
  std::string name;
  bool vein = false;
  double gain = 1;           ///< of what the pulse does to its surroundings, and of what is shown; 1 = physical
  double mean_pressure = 0;  ///< in its middle, at rest [Pa]
  interactions::VesselPath path;

  bool pulses() const noexcept { return gain > 0; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("path", s.path), v("gain", s.gain), v("mean_pressure", s.mean_pressure), v("vein", s.vein),
        v("name", s.name, core::kNotHashed);
  }
};
/// From a distance on something is drawn with fewer triangles and a simpler surface (view/base/level_of_detail.hpp).
struct DetailLevel {
  double from = 0;   ///< [m] in a picture 600 px high through a lens of 70 degrees
  double error = 0;  ///< [m] by which its surface may depart from the full one
  int surface = 2;   ///< how much of its patterns is drawn, as render::Quality::detail

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("from", s.from), v("error", s.error), v("surface", s.surface);
  }
};
struct DrawnDetail {
  std::string name;  ///< as in the scene
  std::vector<DetailLevel> levels;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("name", s.name), v("levels", s.levels);
  }
};

/// A vessel that opens by itself.
struct Bleeder {
  std::int32_t vessel = -1;  ///< -1: none does
  double s = 0;              ///< 0 .. 1 along it
  double area = 0;           ///< of the hole [m^2]
  std::uint64_t tick = 0;    ///< when

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("vessel", s.vessel), v("s", s.s), v("area", s.area), v("tick", s.tick);
  }
};
struct VesselsModel {
  std::vector<Vessel> list;
  Bleeder bleeder;
  vessels::FlowModel flow;
  vessels::FlowState start;  ///< after some seconds of heartbeat

  bool there() const noexcept { return !list.empty(); }

  static constexpr bool kOwnHash = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("flow", s.flow), v("list", s.list), v("bleeder", s.bleeder, core::only_if(s.bleeder.vessel >= 0)),
        v("start", s.start, core::kNotHashed);
  }
};

/// Fluids, where a scene has any.
struct WetModel {
  bool there = false;
  fluids::FluidsModel model;
  std::vector<float> floor;        ///< of the pool without organs, (ny x nx) [m]
  std::vector<int> floor_organs;   ///< that are part of it as they lie
  std::vector<std::int32_t> film;  ///< (bodies + 1) where the places of film of each begin (interactions::WetBodies)
  std::vector<interactions::SkinGrid> grids;  ///< (walls) for what drops meet there
  fluids::Mix pool_at_start;                  ///< that lies there when it begins [pL]

  static constexpr bool kOwnHash = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("model", s.model), v("floor", s.floor), v("floor_organs", s.floor_organs), v("film", s.film),
        v("pool_at_start", s.pool_at_start, core::only_if(!s.pool_at_start.empty())),
        v("there", s.there, core::kNotHashed), v("grids", s.grids, core::kNotHashed);
  }
};

/// Current and heat, where a scene has them.
struct EnergyModel {
  bool there = false;
  tissue::HeatModel heat;
  tissue::GeneratorPanel panel;                   ///< as it is set at the beginning
  std::vector<geometry::CellMask> organs, folds;  ///< what of them is tissue (heat_bodies.hpp)

  static constexpr bool kOwnHash = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("heat", s.heat), v("panel", s.panel), v("organs", s.organs), v("folds", s.folds),
        v("there", s.there, core::kNotHashed);
  }
};

/// A hand at a trocar, and the instruments that go through it.
struct HandModel {
  std::string name;                           ///< of the trocar: "left_lateral"
  Vec3d port;                                 ///< its fulcrum [m]
  kinematics::PortModel give;                 ///< of the abdominal wall there; rigid unless the scene says
  double seal_friction = 0.5;                 ///< of its seal along a shaft, for who feels it; the step does not [N]
  std::vector<interactions::ToolModel> rack;  ///< 1..kMaxRack; the first is in the hand at the start
  std::int32_t membrane = -1;                 ///< that its jaws hold at the start; -1: they hold nothing
  std::vector<std::int32_t> held;             ///< nodes of it between them then, 1..interactions::kMaxHolds

  int find(const std::string& instrument) const;  ///< number in the rack, -1 if it is not there

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rack", s.rack, core::FieldNote{.sized = true}), v("membrane", s.membrane, core::only_if(s.membrane >= 0)),
        v("held", s.held, core::only_if(s.membrane >= 0)), v("name", s.name, core::kNotHashed),
        v("give", s.give, core::only_if(s.give.moves())), v("port", s.port, core::kNotHashed),
        v("seal_friction", s.seal_friction, core::kNotHashed);
  }
};

struct ScopeModel {
  Vec3d port;
  kinematics::FulcrumLimits limits;
  double angle = 0;            ///< of the oblique view [rad]
  double field_of_view = 1.2;  ///< full cone [rad]
  double shaft_radius = 0.005;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("port", s.port), v("limits", s.limits), v("angle", s.angle), v("field_of_view", s.field_of_view),
        v("shaft_radius", s.shaft_radius, core::kNotHashed);
  }
};

/// Something whose visibility the simulation knows: `visible` when at least half of its samples are seen.
struct VisibilityTarget {
  enum Kind : std::int32_t { jaw, shaft, strand, organ, mark, fold } kind = jaw;
  std::string name;                   ///< "tube_left.isthmus", "uterus", "left_lateral.jaw_a", "left_lateral.shaft"
  std::int32_t index = 0;             ///< hand, strand, organ, mark or membrane
  std::int32_t first = 0, count = 0;  ///< samples

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("kind", s.kind), v("name", s.name), v("index", s.index), v("first", s.first), v("count", s.count);
  }
};
struct VisibilitySample {
  std::int32_t target = 0;
  std::int32_t where = 0;  ///< jaw 0/1, strand element, skin vertex; of a mark its number (mark_sample)
  double w = 0;            ///< within the element; shaft: share of the way from the trocar to the jaws

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("target", s.target), v("where", s.where), v("w", s.w);
  }
};

struct State;

/// A Model names things; State and Work have only numbers.
struct Model : interactions::BodyModels {
  std::string name, file;
  std::string anatomy, anatomy_title;  ///< the variant that the seed has; empty: the scene has none
  Vec3d gravity;
  std::vector<WallModel> walls;
  std::vector<DrawnFold> drawn_folds;
  std::vector<interactions::BondSet> bonds;
  interactions::ObjectModels objects;
  VesselsModel vessels;
  WetModel wet;
  EnergyModel energy;
  InjectionModel injection;
  MotionModel motion;
  tissue::Box cavity{{-1e9f, -1e9f, -1e9f}, {1e9f, 1e9f, 1e9f}};  ///< nothing leaves it (containing.hpp)
  std::vector<HandModel> hands;                                   ///< at most kMaxTools
  ScopeModel scope;
  Input start;  ///< everything as placed
  std::vector<interactions::SurfacePair> surface_pairs;
  std::vector<interactions::StrandPair> strand_pairs;
  std::vector<interactions::CarriedPair> carried_pairs;  ///< bodies that may be carried to each other
  std::vector<interactions::SelfPair> self_pairs;        ///< of organs that can be folded onto themselves
  std::vector<std::int32_t> nearest_at_start;            ///< initial State::nearest
  std::vector<MarkModel> marks;
  std::vector<VisibilityTarget> targets;
  std::vector<VisibilitySample> samples;
  std::vector<DrawnDetail> drawn_detail;         ///< nothing that the step reads: not in the hash
  std::shared_ptr<const MaterialLibrary> looks;  ///< materials (looks.hpp), not in the hash; null: all neutral
  std::uint64_t hash = 0;

  /// The instrument that hand `hand` has in its trocar.
  const interactions::ToolModel& tool(const State& state, size_t hand) const noexcept;
  /// The one it begins with.
  const interactions::ToolModel& placed(size_t hand) const noexcept { return hands[hand].rack.front(); }

  bool bends() const noexcept;                    ///< some instrument does, in some rack
  bool ports_move() const noexcept;               ///< some trocar's fulcrum does
  bool irrigates() const noexcept;                ///< there are fluids, and a suction-irrigator in a rack
  double syringe_of(size_t hand) const noexcept;  ///< what the first needle in its rack holds [m^3]; 0: there is none
  int free_nodes() const;                         ///< nodes that move, all bodies
  int surfaces() const { return organs() + int(walls.size()); }  ///< organs first
  const std::string& organ_name(int organ) const;
  const std::string& organ_look(int organ) const;
  int organ_index(const std::string& organ) const;        ///< -1 if there is none
  int strand_index(const std::string& strand) const;      ///< -1 if there is none
  int membrane_index(const std::string& membrane) const;  ///< -1 if there is none
  int target_index(const std::string& target) const;      ///< -1 if there is none
  int vessel_index(const std::string& vessel) const;      ///< -1 if there is none
  int bonds_index(const std::string& bonds) const;        ///< -1 if there are none
  int hand_index(const std::string& trocar) const;        ///< -1 if there is none

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("gravity", s.gravity), v("solids", s.solids), v("cuttables", s.cuttables), v("strand_bodies", s.strand_bodies),
        v("strands", s.strands), v("walls", s.walls), v("membranes", s.membranes),
        v("fat", s.fat, core::only_if(!s.fat.empty())), v("rows", s.rows), v("hands", s.hands), v("scope", s.scope),
        v("start", s.start), v("cavity", s.cavity), v("surface_pairs", s.surface_pairs),
        v("strand_pairs", s.strand_pairs), v("carried_pairs", s.carried_pairs, core::only_if(!s.carried_pairs.empty())),
        v("self_pairs", s.self_pairs), v("samples", s.samples), v("marks", s.marks),
        v("vessels", s.vessels, core::only_if(s.vessels.there())), v("wet", s.wet, core::only_if(s.wet.there)),
        v("energy", s.energy, core::only_if(s.energy.there)),
        v("injection", s.injection, core::only_if(s.injection.there())),
        v("motion", s.motion, core::only_if(s.motion.there())), v("objects", s.objects),
        v("statics", s.statics, core::only_if(!s.statics.empty())),
        v("bonds", s.bonds, core::only_if(!s.bonds.empty())), v("name", s.name, core::kNotHashed),
        v("file", s.file, core::kNotHashed), v("anatomy", s.anatomy, core::kNotHashed),
        v("anatomy_title", s.anatomy_title, core::kNotHashed), v("drawn_folds", s.drawn_folds, core::kNotHashed),
        v("nearest_at_start", s.nearest_at_start, core::kNotHashed), v("targets", s.targets, core::kNotHashed),
        v("looks", s.looks, core::kNotHashed), v("drawn_detail", s.drawn_detail, core::kNotHashed),
        v("hash", s.hash, core::kNotHashed);
  }
};

/// Of parts that a scene may lack, with what their figures do not say: see model.cpp.
void add_to_hash(core::Hasher& hasher, const VesselsModel& vessels) noexcept;
void add_to_hash(core::Hasher& hasher, const WetModel& wet) noexcept;
void add_to_hash(core::Hasher& hasher, const EnergyModel& energy) noexcept;

/// Sets Model::hash from everything that the step reads.
void seal(Model& model);

}  // namespace trocar::sim
