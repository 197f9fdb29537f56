// What a person writes in a scene file, with names and places in the file: editable, no indices, no physics state.
// compile() turns it into a sim::Model. All lengths are in metres here (files say _mm), angles in radians.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/geometry/tets/tet_mesh.hpp>
#include <trocar/interactions/instrument/tool_kind.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/scene/description/body_shape.hpp>
#include <trocar/scene/objects/bond_setting.hpp>
#include <trocar/scene/description/instrument_mechanism.hpp>
#include <trocar/scene/description/stiffness_region.hpp>
#include <trocar/scene/description/vessel_tree.hpp>
#include <trocar/scene/objects/object_scenes.hpp>

namespace trocar::sim {
struct MaterialLibrary;
}

namespace trocar::scene {

/// One row of the tissue table. sigma = E eps (1 + P1 |eps| + P2 eps^2), linear beyond strain_cap.  [KCM99 eq.5]
struct Tissue {
  std::string name;
  double density = 1050;      ///< [kg/m^3]
  double young = 0;           ///< E [Pa]
  double poisson = 0.25;      ///< nu of organs, 1/4 to 0.45; strands and folds do not use it
  double p1 = 0, p2 = 0;      ///< shape factors
  double strain_cap = 0.2;    ///< the law continues linearly beyond it
  double failure_strain = 0;  ///< tears beyond it (0: never)
  double damping_ms = 2;      ///< stiffness-proportional damping, a time [ms]
  double fracture = 0;        ///< what it takes to tear a square metre of it off (0: bonds never do) [J/m^2]
  double puncture = 0.5;      ///< force at which a needle's tip gets through its surface (0: none does) [N]
  double stitch_damage = 0;   ///< of a stitch's pull, from which on it harms [N]; 0: interactions::StitchTissue's
  double strangle = 0;        ///< tension of a loop that cuts through a strand [N]; 0: 8, our choice
  std::string source;         ///< literature or "ours": of the figures that have no source of their own below
  std::array<std::string, 12> source_of;  ///< in the order of kTissueFigures; empty: `source`
  core::Location at;
};
/// The figures of a tissue, as files name them.
struct TissueFigure {
  const char* key;
  double Tissue::*value;
};
inline constexpr std::array<TissueFigure, 12> kTissueFigures{{{"density_kg_m3", &Tissue::density},
                                                              {"young_Pa", &Tissue::young},
                                                              {"poisson", &Tissue::poisson},
                                                              {"p1", &Tissue::p1},
                                                              {"p2", &Tissue::p2},
                                                              {"strain_cap", &Tissue::strain_cap},
                                                              {"failure_strain", &Tissue::failure_strain},
                                                              {"damping_ms", &Tissue::damping_ms},
                                                              {"fracture_J_m2", &Tissue::fracture},
                                                              {"puncture_N", &Tissue::puncture},
                                                              {"stitch_damage_N", &Tissue::stitch_damage},
                                                              {"strangle_N", &Tissue::strangle}}};

/// A section of a lofted body: a super-ellipse with two half-axis vectors.
struct Section {
  Vec3d centre, across, deep;
  double squareness = 2;  ///< 2 = ellipse
};

/// Tetrahedra from a file: a mesh, or what fills a label of a voxel volume.
struct TetSource {
  std::string file;                   ///< as named, relative to the file that names it
  double unit = 1e-3;                 ///< of a mesh's coordinates [m]
  double refill = 0;                  ///< cubes with whose tetrahedra a mesh's surface is filled again [m]; 0: as it is
  int label = 0;                      ///< of voxels; 0: a mesh
  int smoothing = 1;                  ///< of the label's steps, in passes
  Vec3d place;                        ///< where the file's origin goes [m]
  geometry::TetMesh mesh;             ///< as mended where the file's was not sound
  std::vector<std::string> warnings;  ///< what was mended, and what has several ways to be
};

/// How an organ is solved: step by step (its spring network), or at once (tissue/elastostatic).
enum class Solver { dynamic_network, elastostatic };
/// What the elastostatic solver's stiffness is made of.
enum class Elasticity { springs, tetrahedra };
/// What an elastostatic organ does that has turned further than its solver is good for.
enum class BeyondLinear { warn, switch_to_dynamic };

/// Where the masses of an organ are: in what fills it, or at the control points of its NURBS surface and below them.
enum class Masses { inside, control_points };

/// A line drawn along an organ's fibres, point by point [m].
using Stroke = std::vector<Vec3d>;

/// A volumetric organ: a spline loft, another closed shape, or tetrahedra from a file. A shape is filled with an
/// elastic lattice of cubic cells, or with tetrahedra where it can be cut.
struct Solid {
  std::string name, tissue, look;
  std::vector<Section> sections;  ///< empty where there are tets or another shape
  std::optional<TetSource> tets;
  ClosedShape shape;
  Masses masses = Masses::inside;
  bool cuttable = false;
  Vec3d fibre{0, 0, 0};               ///< one direction, any length; zero: none, or what follows says it (fibres.hpp)
  std::vector<Stroke> fibre_strokes;  ///< drawn along the fibres
  bool fibres_along = false;          ///< they run along the body's own middle line
  double fibre_ratio = 1;             ///< E along the fibres over E across
  std::vector<StiffnessRegion> regions;
  double cell = 0;       ///< lattice edge [m]; 0 for a mesh
  double skin_edge = 0;  ///< contact skin's edge length [m]
  double fine_edge = 0;  ///< drawn skin's edge length [m]
  std::vector<Anchor> anchors;
  Solver solver = Solver::dynamic_network;
  Elasticity elasticity = Elasticity::springs;
  double beyond_angle = portable::pi / 18;  ///< tissue::ElastostaticState::turn [rad]
  BeyondLinear beyond = BeyondLinear::warn;
  core::Location at, cell_at, solver_at;

  bool at_control_points() const { return masses == Masses::control_points; }
  bool is_quasi_static() const { return solver == Solver::elastostatic; }
  /// Do fibres turn, or stiffness change, from place to place?
  bool differs_by_place() const { return !fibre_strokes.empty() || fibres_along || !regions.empty(); }
};

struct StrandStation {
  double s = 0;           ///< arc length from the start [m]
  double radius = 0.001;  ///< outer [m]
  double lumen = 0;       ///< lumen radius [m], 0 = solid cord
};

/// Where a strand's end hangs: on a solid organ at a point (its skin nearest to that point), at a fixed point in space,
/// or free (organ empty and fixed false).
struct StrandEnd {
  std::string organ;  ///< empty: not on an organ
  bool fixed = false;
  core::Location at;
};

/// A named stretch of a strand, used by exercises ("isthmus", "ampulla", "fimbria").
struct Landmark {
  std::string name;
  double from = 0, to = 0;  ///< arc length [m]
};

/// A thin tube or cord: cubic spline centre-line through the points, implicit strand.
struct Strand {
  std::string name, tissue, look;
  std::vector<Vec3d> centreline;        ///< interpolated points [m]
  std::vector<StrandStation> stations;  ///< radius and lumen along it, linear in between
  std::vector<Landmark> landmarks;
  StrandEnd start, end;
  double spacing = 0.0025;      ///< node distance [m]
  double foundation = 0;        ///< elastic foundation per length [N/m^2]: the mesentery's hold
  double foundation_limit = 0;  ///< displacement at which the foundation's stiffness has doubled [m]; 0: linear
  bool cuttable = true;
  bool fimbriated = false;  ///< the end flares into fimbriae
  core::Location at, spacing_at;
};

/// A surface that does not move: a NURBS patch from a grid of control points (rows x columns), drawn and touched.
struct Wall {
  std::string name, look;
  int rows = 0, columns = 0;
  std::vector<Vec3d> net;  ///< rows * columns control points [m], normal = d/drow x d/dcolumn points to the free side
  std::vector<double> weights;      ///< > 0, in the same order; empty: all 1
  std::array<int, 2> degree{0, 0};  ///< along a row, along a column; 0: cubic, or as many points as there are allow
  std::vector<double> knots_u, knots_v;  ///< of the domain along a row and a column; empty: uniform
  double edge = 0.004;                   ///< tessellation [m]
  core::Location at;
};

/// Of its patch: along a row (0), along a column (1). @throws std::invalid_argument where they do not go with the net
inline geometry::nurbs::Knots knots_of(const Wall& wall, int way) {
  const int points = way == 0 ? wall.columns : wall.rows;
  const int degree = wall.degree[std::size_t(way)] > 0 ? wall.degree[std::size_t(way)] : std::min(3, points - 1);
  return clamped_by(degree, points, way == 0 ? wall.knots_u : wall.knots_v, way == 0 ? "knots_u" : "knots_v");
}

/// A thin translucent fold drawn between a strand and a line of points that ride on other bodies or on space.
/// Mechanically it is the strand's foundation in this version.
struct Sheet {
  std::string name, look, strand;
  double from = 0, to = 0;  ///< the strand's arc length [m]
  std::vector<Vec3d> base;  ///< polyline of the fold's other border [m]
  std::string base_organ;   ///< solid or strand that the base rides on; empty: space
  core::Location at;
};

/// A thin fold that is a body of its own: a membrane between a stretch of a strand and a base line. Points of the base
/// that lie within `base_reach` of one of the bodies `base_on` ride on it, the others stay in space.
struct Membrane {
  std::string name, tissue, look, strand;
  double from = 0, to = 0;           ///< the strand's arc length [m]
  std::vector<Vec3d> base;           ///< polyline of the other border, in the same direction [m]
  std::vector<std::string> base_on;  ///< solids and strands
  double base_reach = 0.004;         ///< [m]
  double thickness = 0;              ///< [m]
  double spacing = 0.0025;           ///< of its nodes [m]
  bool cuttable = true;
  core::Location at, spacing_at;
};

/// What a pouch is filled with.
struct Contents {
  enum Kind { nothing, constant, liquid, gas } kind = nothing;
  double pressure = 0;  ///< over the surroundings, in the drawn shape [Pa]
  double bulk = 2e5;    ///< of a liquid [Pa]
  double density = 0;   ///< [kg/m^3]
};

/// A thin closed wall around something: gallbladder, bladder. The wall's nodes within a ball of `held` (anchors, all
/// rigid) ride on the nearest of the bodies `held_on` within `held_reach`, or stay in space.
struct Pouch {
  std::string name, tissue, look;
  std::vector<Section> sections;  ///< empty where there is another shape
  ClosedShape shape;
  double thickness = 0;    ///< [m]
  double spacing = 0.004;  ///< of its nodes [m]
  std::vector<StiffnessRegion> regions;
  std::vector<Anchor> held;
  std::vector<std::string> held_on;  ///< solids and strands
  double held_reach = 0.004;         ///< [m]
  std::vector<BondSetting> bonds;
  Contents contents;
  bool cuttable = true;
  bool free = false;  ///< nothing holds it: it lies where it is put
  std::string duct;   ///< the strand whose lumen opens into it; empty: none
  core::Location at, spacing_at;
};

/// A mark that exercises look for or work at: a disc in space or on a body or wall, a stripe around a strand.
struct MarkSetting {
  std::string name, on;  ///< `on` empty: it stays in space
  bool stripe = false;   ///< else a disc
  Vec3d place;           ///< of a disc [m]
  Vec3d normal;          ///< of a disc, any length; zero: out of the surface that it lies on
  double s = 0;          ///< of a stripe: its middle's arc length [m]
  double size = 0.005;   ///< diameter of a disc, width of a stripe [m]
  std::string label, colour;
  std::string look;  ///< of a disc on an organ: tissue that is changed there, in place of paint
  double high = 0;   ///< by how much such tissue stands out [m]
  core::Location at;
};
inline constexpr std::array<const char*, 7> kMarkColours{"white", "yellow", "orange", "green", "blue", "black", "none"};

struct Port {
  std::string name;
  Vec3d position;
  double diameter = 0.005;
  core::Location at;
  double seal_friction = 0.5;  ///< along a shaft [N]
  double stiffness = 0;        ///< of the wall about it, across a shaft; 0: rigid [N/m]
  double drift = 0;            ///< how far it wanders [m]
  std::uint64_t seed = 0;      ///< of that (vary.hpp)
};

/// Fluids of a scene: where they gather.
struct FluidsSetting {
  Vec3d pool_middle;                 ///< of the square field in which a pool can be [m]
  double pool_size = 0.160;          ///< its edge [m]
  std::vector<std::string> pool_on;  ///< solids whose tops are part of its floor, beside the walls
  int drops = 4096;                  ///< at a time
  double pool_at_start = 0;          ///< blood that lies there when it begins [m^3]
  double bile_at_start = 0;          ///< bile, with it [m^3]
  core::Location at;
};

/// Vessels that open by themselves, one an attempt: what exercises on bleeding begin with.
struct BleederSetting {
  struct Hole {
    std::string vessel;
    double at = 0.5;           ///< 0 .. 1 along it
    double diameter = 0.5e-3;  ///< [m]
    core::Location where;
  };
  double opens = 5;  ///< [s] after the start
  std::vector<Hole> holes;
  int which = 0;  ///< of the holes; vary() chooses where the scene says so
};

/// The generator's panel, and how much heat is remembered. A scene that has it computes heat.
struct EnergySetting {
  bool blend = false;                                             ///< what the yellow pedal gives, else cut
  double yellow_watts = 40, blue_watts = 40, bipolar_watts = 30;  ///< [W]
  double cell = 0.0005;                                           ///< of the heat's grid [m]
  int bricks = 256, awake = 128;                                  ///< tissue::HeatDescription
  core::Location at;
};

/// Waves of contraction that run along a hollow organ: peristalsis.
struct WaveSetting {
  struct Station {
    double s = 0;          ///< way along the centre line [m]
    double pressure = 0;   ///< at the crest [Pa]
    double speed = 0.010;  ///< [m/s]
    core::Location at;
  };
  std::string solid;
  std::vector<Vec3d> centreline;  ///< points, in the waves' direction [m]; empty: the centres of the solid's sections
  std::vector<Station> stations;  ///< linear in between
  double per_minute = 3;
  double width = 0.010;     ///< sigma of a wave's profile [m]
  double first = 0;         ///< when a crest is at the line's beginning [s]
  double cycle = 60;        ///< [s]
  double active_share = 1;  ///< of a cycle
  core::Location at, width_at, solid_at, centreline_at;
};

/// Breathing: what hangs in space on the diaphragm and below it goes along.
struct BreathingSetting {
  struct Carried {
    std::string body;
    double share = 1;  ///< of the amplitude
    core::Location at;
  };
  double per_minute = 13;
  double amplitude = 0.010;      ///< from end-expiration to end-inspiration [m]
  Vec3d direction{0, -1, 0};     ///< of inspiration, any length
  std::vector<Carried> carries;  ///< solids, strands, membranes, pouches
  core::Location at;
};

/// How finely some things are drawn, by how far off they are (view/base/level_of_detail.hpp). No levels: in full,
/// always.
struct DetailSetting {
  struct Level {
    double from = 0, error = 0;  ///< sim::DetailLevel [m]
    int surface = 2;
  };
  std::vector<std::string> of;  ///< bodies, walls, instruments, ports, and kDrawnNames
  std::vector<Level> levels;
  core::Location at;
};
/// What is drawn and has no name of its own in a file.
inline constexpr std::array<const char*, 4> kDrawnNames{"cavity", "endoscope", "arteries", "veins"};

struct Description;

/// What of a scene is another one with another seed, and by how much at most (vary.hpp).
struct VariationSetting {
  /// A part of space that is bent with all that lies there, whole about its middle, fading out further off.
  struct Region {
    std::string around;      ///< a strand: its beginning; a solid: the middle of its sections; empty: `centre`
    Vec3d centre;            ///< [m]
    Vec3d towards;           ///< only on this side of the middle, any length; zero: all around
    double begins = -0.001;  ///< way in that direction at which it begins [m]
    double whole = 0.016;    ///< and at which it is whole
    double near = 0.055;     ///< whole within this distance of the middle [m]
    double far = 0.120;      ///< nothing beyond
    double scale = 0;        ///< of lengths, relative
    double length = 0;       ///< of lengths along `axis`, relative
    double shift = 0;        ///< along each axis [m]
    double turn = 0;         ///< about `axis` [rad]
    Vec3d axis{0, 0, 1};     ///< any length
    core::Location at, around_at;
  };
  /// Thicker or thinner: all of these by one share.
  struct Girth {
    std::vector<std::string> of;  ///< solids, strands, pouches
    double radius = 0;            ///< half axes and radii, relative
  };
  /// Something that is found in some patients: a mark, and what goes with it.
  struct Finding {
    std::string mark;
    std::vector<std::string> with;  ///< marks that are there when it is
    double share = 0;               ///< of patients, whatever else they have; 0: one of `present`
    std::string solid;              ///< is narrow there; empty: none
    double narrower = 0;            ///< its half axes in the middle, relative
    double over = 0.020;            ///< as far to either side, fading out [m]
    core::Location at;
  };
  /// Another anatomy that some patients have: at most one of them a patient.
  struct Variant {
    /// Where a pouch's wall rides on something that the variant brings.
    struct Hold {
      std::string pouch, on;
      Vec3d centre;       ///< [m]
      double radius = 0;  ///< of its nodes that ride [m]
      Vec3d instead;      ///< the pouch's hold nearest to this ends; zero: none does [m]
      core::Location at;
    };
    /// More of a fat that the scene has; nothing where it has none of that name.
    struct MoreFat {
      std::string of;
      std::vector<FatSetting::Fill> fills;
      std::vector<std::string> on;
      core::Location at;
    };
    std::string name, title, source;
    double share = 0;                           ///< of patients
    std::shared_ptr<const Description> brings;  ///< bodies, vessels and marks; each in place of the one of its name
    std::vector<Hold> holds;
    std::vector<MoreFat> fat;
    core::Location at;
  };
  std::vector<Region> regions;
  std::vector<Girth> girths;
  std::vector<Finding> findings;
  std::vector<Variant> variants;
  int present = 0;        ///< so many of the findings without a share are there
  double stiffness = 0;   ///< of every tissue, relative
  double foundation = 0;  ///< of every strand's hold, relative
  bool bleeder = false;   ///< which of its holes opens
  core::Location at;
};

/// The part of an instrument that current leaves from.
struct ElectrodeSetting {
  double radius = 0.001;     ///< of its contact [m]
  double efficiency = 0.45;  ///< share of the generator's power that heats tissue
  double stick_force = 2;    ///< to tear it off char [N]
  double seals = 0;          ///< largest outer diameter of vessels that it seals [m]; 0: 1 mm bare, 3 mm between jaws
};

/// Of an injection needle: the needle, and the syringe behind it.
struct NeedleSetting {
  double length = 0.020, diameter = 0.0007, bore = 0.00041;  ///< 22 G [m]
  double plunger = 0.0145;                                   ///< inner diameter of the syringe [m]
  double holds = 10e-6;                                      ///< [m^3]
  double flow = 10e-6;                                       ///< that a hand has in mind [m^3/min]
  double most_force = 40;                                    ///< of a thumb [N]
  double units = 0;                                          ///< of a drug that narrows vessels [IU/mL]; 0: saline
};

/// An instrument's shape and grip. Jaws open symmetrically in the plane of the shaft axis and the opening direction.
struct Instrument {
  std::string name, title;
  interactions::ToolKind kind = interactions::ToolKind::probe;
  double shaft_radius = 0.0025, shaft_length = 0.310;
  double jaw_length = 0.020, jaw_width = 0.003, jaw_thickness = 0.0015;
  double opening = 1.0;     ///< full opening between the jaws [rad], or for parallel jaws
  double parallel_gap = 0;  ///< clip applier: gap between parallel jaws when open [m] (then opening = 0)
  double foot = 0;          ///< hook: how far its foot reaches from the wire's axis [m]; 0: it has none
  double pinch_max = 15;    ///< force between the jaws when the handle is fully closed on tissue [N]
  double friction = 1.67;   ///< pull the grip bears per pinch force: profiled jaws hold 5 N with 3 N [Heijnsdijk 04]
  double clip_length = 0.0085;    ///< clip applier: length of a closed clip [m]
  int clips = 0;                  ///< clips in the magazine
  ElectrodeSetting electrode;     ///< of hooks and bipolar forceps
  NeedleSetting needle;           ///< of injection needles
  NamedMechanism linkage;         ///< between handle and jaws; none: they open as the handle does
  std::string handle = "handle";  ///< the linkage's actuator
  WristSetting wrist;
  core::Location at;

  const interactions::Abilities& can() const { return about(kind).can; }
};

struct Scope {
  double angle = 0;                                ///< 0, 30 or 45 degrees [rad]
  double field_of_view = 70 * portable::pi / 180;  ///< full cone [rad]
  double shaft_radius = 0.005, shaft_length = 0.310;
};

/// Where an instrument or the scope stands at the start: through which port, aimed at which point, how deep.
struct Placement {
  std::string instrument;  ///< empty for the scope
  std::string port;
  Vec3d tip;  ///< tip position at the start [m]
  double roll = 0;
  core::Location at;
  std::string holds{};  ///< a pouch that its jaws hold at the start; empty: nothing
};

/// What a patient without a variant has; none is called so.
inline constexpr const char* kCommonAnatomy = "common";

struct Description {
  std::string name, title, file;
  Vec3d gravity{0, 0, -9.81};  ///< [m/s^2], patient frame: tilt included
  std::vector<Tissue> tissues;
  std::vector<Solid> solids;
  std::vector<Strand> strands;
  std::vector<Wall> walls;
  ObjectSettings objects;
  std::vector<Sheet> sheets;
  std::vector<Membrane> membranes;
  std::vector<Pouch> pouches;
  std::vector<VesselTree> vessels;  ///< heart and blood are the first one's
  std::optional<FluidsSetting> fluids;
  std::optional<BleederSetting> bleeder;
  std::optional<EnergySetting> energy;
  std::vector<WaveSetting> peristalsis;
  std::optional<BreathingSetting> breathing;
  std::vector<DetailSetting> detail;
  std::optional<VariationSetting> variation;
  std::string variant;  ///< of the variation's, which every seed has; empty: the seed draws
  std::string anatomy;  ///< what vary() made of it: a variant's name, kCommonAnatomy; empty: there are no variants
  std::shared_ptr<const sim::MaterialLibrary> looks;  ///< those that are there; null: none
  std::vector<MarkSetting> marks;
  std::vector<Port> ports;
  std::vector<Instrument> instruments;
  std::vector<Placement> placements;  ///< tools, in hand order: [0] left, [1] right, [2] assistant/third
  Scope scope;
  Placement scope_placement;
};

}  // namespace trocar::scene
