// The keys of scene, organ, instrument and tissue files: one table per kind of object. Ranges are what a person could
// mean, wide enough for any organ; they catch slips of units and of the decimal point.
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/vessel_file.hpp>

namespace trocar::scene {
namespace {

constexpr double kFar = 2000;  // [mm]: no place in a body is further from the umbilicus

const Shape& tissue_sources() {
  static const Shape shape = [] {
    Shape s{"sources", "Where single figures of a tissue come from: a publication, or \"ours\".", {}};
    for (const TissueFigure& figure : kTissueFigures) s.keys.push_back(keys::text(figure.key, "of this figure"));
    return s;
  }();
  return shape;
}

const Shape& tissue_row() {
  static const Shape shape{
      "tissue",
      "A material: sigma = E eps (1 + p1 |eps| + p2 eps^2), continued linearly beyond strain_cap.",
      {needed(keys::name("name", "what solids and strands call it")),
       needed(keys::number("density_kg_m3", 1, 25000, "mass per volume")),
       needed(keys::number("young_Pa", 1, 1e9, "Young's modulus E at small strain")),
       keys::number("poisson", 0.25, 0.45,
                    "Poisson's ratio of organs, default 0.25, that of springs alone; more costs a volume force"),
       keys::number("p1", -1000, 1000, "first shape factor, default 0; monotone law: p1^2 < 3 p2"),
       keys::number("p2", 0, 1e6, "second shape factor, default 0"),
       keys::number("strain_cap", 0.01, 5, "strain beyond which the law is continued linearly, default 0.2"),
       keys::number("failure_strain", 0, 10, "strain at which it tears, default 0: never"),
       keys::number("damping_ms", 0, 1000, "stiffness-proportional damping time, default 2"),
       needed(keys::text("source", "where the figures come from: a publication, or \"ours\"")),
       keys::object("sources", tissue_sources, "sources of single figures, where they differ")}};
  return shape;
}

const Shape& section() {
  static const Shape shape{"section",
                           "A cross-section of a lofted body: a super-ellipse with two half-axis vectors.",
                           {needed(keys::vec3("centre_mm", -kFar, kFar, "centre")),
                            needed(keys::vec3("across_mm", -500, 500, "first half axis")),
                            needed(keys::vec3("deep_mm", -500, 500, "second half axis")),
                            keys::number("squareness", 1, 10, "exponent of the super-ellipse, default 2: an ellipse")}};
  return shape;
}

const Shape& anchor() {
  static const Shape shape{"anchor",
                           "The nodes within a ball are held where they are, rigidly or by springs.",
                           {needed(keys::vec3("centre_mm", -kFar, kFar, "centre of the ball")),
                            needed(keys::number("radius_mm", 0.1, 500, "radius of the ball")),
                            keys::number("stiffness_N_m", 0, 1e6, "of all springs together, default 0: rigid")}};
  return shape;
}

const Shape& tet_mesh() {
  static const Shape shape{"mesh",
                           "Tetrahedra from a file: Gmsh .msh or legacy VTK.",
                           {needed(keys::text("file", "its name, relative to this file")),
                            keys::number("unit_mm", 1e-6, 1e6, "unit of its coordinates, default 1"),
                            keys::vec3("place_mm", -kFar, kFar, "where its origin goes, default 0, 0, 0")}};
  return shape;
}

const Shape& voxel_body() {
  static const Shape shape{"voxels",
                           "What fills one label of a segmented volume: NRRD, as 3D Slicer saves it.",
                           {needed(keys::text("file", "its name, relative to this file")),
                            needed(keys::integer("label", 1, 65535, "the value of the organ's voxels")),
                            keys::integer("smoothing", 0, 16, "passes that take away the voxels' steps, default 1"),
                            keys::vec3("place_mm", -kFar, kFar, "where its origin goes, default 0, 0, 0")}};
  return shape;
}

const Shape& solid() {
  static const Shape shape{
      "solid",
      "A volumetric organ. Its shape is one of: sections (a smooth loft), mesh, voxels. A loft is filled with an "
      "elastic "
      "lattice of cubic cells, or with tetrahedra where it is cuttable; the others are tetrahedra always.",
      {needed(keys::name("name", "what scenes and exercises call it")), needed(keys::name("tissue", "its material")),
       keys::name("look", "its surface in the picture, default: its name"),
       keys::objects("sections", section, 2, "from one end to the other"),
       keys::object("mesh", tet_mesh, "tetrahedra from a file"),
       keys::object("voxels", voxel_body, "a label of a volume, filled with tetrahedra"),
       keys::number("cell_mm", 0.1, 100, "edge of the lattice's cubes; needed but for a mesh"),
       keys::flag("cuttable", "can it be cut anywhere, so that pieces come off? default false"),
       keys::vec3("fibre", -1, 1, "direction of its fibres, default: none; not for a lattice"),
       keys::number("fibre_ratio", 0.2, 5, "stiffness along the fibres over across, default 1"),
       keys::number("skin_edge_mm", 0.2, 100, "edge of the touched skin's triangles, default: cell_mm"),
       keys::number("fine_edge_mm", 0.1, 100, "edge of the drawn skin's triangles, default: half of skin_edge_mm"),
       keys::objects("anchors", anchor, 0, "what holds it")}};
  return shape;
}

const Shape& station() {
  static const Shape shape{"station",
                           "Thickness of a strand at one place; linear between stations.",
                           {needed(keys::number("s_mm", 0, 5000, "arc length from the start")),
                            needed(keys::number("radius_mm", 0.05, 100, "outer radius")),
                            keys::number("lumen_mm", 0, 100, "radius of the lumen, default 0: a solid cord")}};
  return shape;
}

const Shape& landmark() {
  static const Shape shape{"landmark",
                           "A named stretch of a strand, for exercises.",
                           {needed(keys::name("name", "what exercises call it")),
                            needed(keys::number("from_mm", 0, 5000, "arc length where it begins")),
                            needed(keys::number("to_mm", 0, 5000, "arc length where it ends"))}};
  return shape;
}

const Shape& strand_end() {
  static const Shape shape{"strand end",
                           "Where a strand's end hangs: on a solid, at a fixed place, or nowhere.",
                           {keys::name("solid", "the solid whose skin next to the end carries it"),
                            keys::flag("fixed", "true: held where it is")}};
  return shape;
}

const Shape& strand() {
  static const Shape shape{
      "strand",
      "A thin tube or cord along a smooth line through points.",
      {needed(keys::name("name", "what scenes and exercises call it")), needed(keys::name("tissue", "its material")),
       keys::name("look", "its surface in the picture, default: its name"),
       needed(keys::points("centreline_mm", -kFar, kFar, 2, "points on its centre line, from start to end")),
       needed(keys::objects("stations", station, 1, "thickness along it, by rising s_mm")),
       keys::objects("landmarks", landmark, 0, "named stretches"), keys::object("start", strand_end, "default: free"),
       keys::object("end", strand_end, "default: free"),
       keys::number("spacing_mm", 0.2, 50, "distance of its nodes, default 2.5"),
       keys::number("foundation_N_m2", 0, 1e6, "elastic hold of its fold per length, default 0"),
       keys::number("foundation_limit_mm", 0, 500, "displacement at which that hold has doubled, default 0: linear"),
       keys::flag("cuttable", "default true"),
       keys::flag("fimbriated", "its end flares into fimbriae, default false")}};
  return shape;
}

const Shape& wall() {
  static const Shape shape{
      "wall",
      "A surface that does not move: a NURBS patch over a net of control points; d/drow x d/dcolumn points to the free "
      "side.",
      {needed(keys::name("name", "what it is called")),
       keys::name("look", "its surface in the picture, default: its name"),
       needed(keys::grid("net_mm", -kFar, kFar, 2, "rows of control points")),
       keys::number("edge_mm", 0.5, 200, "edge of its triangles, default 4")}};
  return shape;
}

const Shape& sheet() {
  static const Shape shape{
      "sheet",
      "A thin fold drawn between a strand and a line of points.",
      {needed(keys::name("name", "what it is called")),
       keys::name("look", "its surface in the picture, default: its name"),
       needed(keys::name("strand", "the strand along one border")),
       needed(keys::number("from_mm", 0, 5000, "arc length on the strand where it begins")),
       needed(keys::number("to_mm", 0, 5000, "arc length on the strand where it ends")),
       needed(keys::points("base_mm", -kFar, kFar, 2, "the other border, in the same direction")),
       keys::name("base_organ", "solid or strand that carries the other border, default: none, it stays in place")}};
  return shape;
}

const Shape& membrane() {
  static const Shape shape{
      "membrane",
      "A thin fold with mechanics of its own, between a stretch of a strand and a line of points.",
      {needed(keys::name("name", "what scenes and exercises call it")), needed(keys::name("tissue", "its material")),
       keys::name("look", "its surface in the picture, default: its name"),
       needed(keys::name("strand", "the strand along one border")),
       needed(keys::number("from_mm", 0, 5000, "arc length on the strand where it begins")),
       needed(keys::number("to_mm", 0, 5000, "arc length on the strand where it ends")),
       needed(keys::points("base_mm", -kFar, kFar, 2, "the other border, in the same direction")),
       keys::texts("base_on",
                   "solids and strands that carry the base where it is near them; elsewhere it stays in "
                   "place"),
       keys::number("base_reach_mm", 0.1, 100, "how near that is, from a strand's surface or a skin, default 4"),
       needed(keys::number("thickness_mm", 0.05, 20, "of the fold")),
       keys::number("spacing_mm", 0.3, 50, "distance of its nodes, default 2.5"),
       keys::flag("cuttable", "default true")}};
  return shape;
}

const Shape& held_place() {
  static const Shape shape{"held place",
                           "Where a pouch's wall is held.",
                           {needed(keys::vec3("centre_mm", -kFar, kFar, "centre of a ball")),
                            needed(keys::number("radius_mm", 0.1, 500, "radius of the ball"))}};
  return shape;
}

const Shape& contents() {
  static const Shape shape{
      "contents",
      "What fills a pouch, and the pressure with which it does.",
      {needed(keys::choice("kind", {"liquid", "gas", "constant"},
                           "liquid: p0 + K (V0 - V) / V0; gas: Boyle's law; constant: p0 whatever the volume")),
       needed(keys::number("pressure_Pa", -90000, 1e6, "p0, over the surroundings, as drawn, at the middle")),
       keys::number("bulk_kPa", 0.1, 1e7, "K of a liquid, default 200: how well it holds its volume"),
       keys::number("density_kg_m3", 0, 25000, "default: liquid 1000, else 0")}};
  return shape;
}

const Shape& pouch() {
  static const Shape shape{
      "pouch",
      "A thin closed wall around something: a gallbladder, a bladder.",
      {needed(keys::name("name", "what scenes and exercises call it")), needed(keys::name("tissue", "of its wall")),
       keys::name("look", "its surface in the picture, default: its name"),
       needed(keys::objects("sections", section, 2, "from one end to the other, as a solid's")),
       needed(keys::number("thickness_mm", 0.05, 20, "of the wall")),
       keys::number("spacing_mm", 0.3, 50, "distance of its nodes, default 4"),
       keys::objects("held", held_place, 0, "places where the wall is held"),
       keys::texts("held_on", "solids and strands that hold it where they are near; elsewhere it stays in place"),
       keys::number("held_reach_mm", 0.1, 100, "how near that is, from a strand's surface or a skin, default 4"),
       keys::object("contents", contents, "default: nothing presses"), keys::flag("cuttable", "default true")}};
  return shape;
}

const Shape& organ();

std::vector<Key> organ_keys() {
  return {keys::name("name", "what it is called"),
          keys::includes("organs", organ, "organs that belong to it: files or objects"),
          keys::objects("solids", solid, 0, "volumetric organs"),
          keys::objects("strands", strand, 0, "tubes and cords"),
          keys::objects("walls", wall, 0, "surfaces that do not move"),
          keys::objects("sheets", sheet, 0, "folds that are only drawn"),
          keys::objects("membranes", membrane, 0, "folds that are bodies"),
          keys::objects("pouches", pouch, 0, "closed walls with something inside")};
}

const Shape& organ() {
  static const Shape shape{"organ", "Bodies that belong together, in the scene's frame.", organ_keys()};
  return shape;
}

const Shape& electrode() {
  static const Shape shape{
      "electrode",
      "The part of a hook or of bipolar forceps that current leaves from; without this key, with the defaults.",
      {keys::number("radius_mm", 0.5, 1.5, "of its contact with tissue, default 1"),
       keys::number("efficiency", 0.3, 0.6, "share of the generator's power that heats tissue, default 0.45"),
       keys::number("stick_force_N", 0, 20, "that tears it off char, default 2"),
       keys::number("seals_mm", 0.1, 10,
                    "largest outer diameter of vessels that it seals, default 1, between jaws 3")}};
  return shape;
}

std::vector<Key> instrument_keys() {
  return {needed(keys::name("name", "what scenes call it")),
          keys::text("title", "one line for people"),
          needed(keys::choice("kind",
                              {"grasper", "clip_applier", "scissors", "probe", "suction_irrigator", "hook", "bipolar"},
                              "what it does")),
          keys::number("shaft_diameter_mm", 1, 30, "default 5"),
          keys::number("shaft_length_mm", 50, 1000, "from the handle to the jaws' joint, default 310"),
          keys::number("jaw_length_mm", 1, 100, "default 20"),
          keys::number("jaw_width_mm", 0.2, 30, "default 3"),
          keys::number("jaw_thickness_mm", 0.2, 20, "of one jaw, default 1.5"),
          keys::number("opening_deg", 0, 180, "between the open jaws, default 57"),
          keys::number("parallel_gap_mm", 0, 50, "between parallel jaws when open, default 0: they turn"),
          keys::number("pinch_max_N", 0, 200, "between the jaws with the handle closed, default 15"),
          keys::number("friction", 0, 10, "pull that the grip bears per pinch force, default 1.67"),
          keys::number("clip_length_mm", 0.5, 50, "of a closed clip, default 8.5"),
          keys::integer("clips", 0, 1000, "in the magazine, default 0"),
          keys::object("electrode", electrode, "of a hook or bipolar forceps")};
}

const Shape& instrument() {
  static const Shape shape{"instrument", "An instrument's shape and grip.", instrument_keys()};
  return shape;
}

const Shape& port() {
  static const Shape shape{"port",
                           "A trocar: the point about which an instrument turns.",
                           {needed(keys::name("name", "what tools call it")),
                            needed(keys::vec3("position_mm", -kFar, kFar, "the pivot, in the abdominal wall")),
                            keys::number("diameter_mm", 2, 40, "inner diameter, default 5")}};
  return shape;
}

std::vector<Key> placement_keys() {
  return {needed(keys::name("port", "the port it passes")),
          needed(keys::vec3("tip_mm", -kFar, kFar, "where its tip stands at the start")),
          keys::number("roll_deg", -360, 360, "turned about its shaft, default 0")};
}

const Shape& tool() {
  static const Shape shape = [] {
    Shape s{"tool", "An instrument in a hand at the start.", placement_keys()};
    s.keys.insert(s.keys.begin(), needed(keys::name("instrument", "which instrument")));
    return s;
  }();
  return shape;
}

const Shape& scope() {
  static const Shape shape = [] {
    Shape s{"scope", "The endoscope and where it stands at the start.", placement_keys()};
    s.keys.push_back(keys::number("angle_deg", 0, 90, "between its shaft and its view, default 0"));
    s.keys.push_back(keys::number("field_of_view_deg", 20, 140, "full cone, default 70"));
    s.keys.push_back(keys::number("shaft_diameter_mm", 1, 30, "default 10"));
    s.keys.push_back(keys::number("shaft_length_mm", 50, 1000, "default 310"));
    return s;
  }();
  return shape;
}

const Shape& fluids() {
  static const Shape shape{
      "fluids",
      "Blood that leaves vessels becomes drops and gathers in a pool; without this key it is only counted.",
      {needed(keys::vec3("pool_middle_mm", -kFar, kFar, "middle of the field in which a pool can be")),
       keys::number("pool_size_mm", 20, 1000, "edge of that field, default 160"),
       keys::texts("pool_on", "solids whose tops are part of its floor, as they lie, beside the walls"),
       keys::integer("drops", 64, 65536, "at a time, default 4096")}};
  return shape;
}

const Shape& bleeder_hole() {
  static const Shape shape{"hole",
                           "Where a vessel may open.",
                           {needed(keys::name("vessel", "artery or vein of the scene")),
                            needed(keys::number("at", 0, 1, "place along it: 0 its beginning, 1 its end")),
                            needed(keys::number("diameter_mm", 0.01, 20, "of the hole"))}};
  return shape;
}
const Shape& bleeder() {
  static const Shape shape{"bleeder",
                           "A vessel opens by itself: one of these holes, which one depends on the seed.",
                           {needed(keys::objects("holes", bleeder_hole, 1, "where that may be")),
                            keys::number("opens_s", 0, 36000, "when, after the start, default 5")}};
  return shape;
}

const Shape& energy() {
  static const Shape shape{
      "energy",
      "What the generator's panel is set to; without this key instruments have no current and nothing is heated.",
      {keys::choice("yellow", {"cut", "blend"}, "what the yellow pedal gives, default cut"),
       keys::number("yellow_W", 0, 120, "default 40"), keys::number("blue_W", 0, 120, "coagulation, default 40"),
       keys::number("bipolar_W", 0, 120, "blue pedal, bipolar forceps, default 30"),
       keys::number("cell_mm", 0.25, 0.75, "edge of the cells in which heat is computed, default 0.5"),
       keys::integer("bricks", 8, 4096, "of 8 x 8 x 8 cells that can be remembered, default 256"),
       keys::integer("awake", 8, 2048, "of them that can be warm at once, default 128")}};
  return shape;
}

const Shape& wave_station() {
  static const Shape shape{
      "wave station",
      "What waves are like at one place of the centre line; linear between stations.",
      {needed(keys::number("s_mm", 0, 5000, "way along the centre line")),
       needed(keys::number("pressure_kPa", 0, 100, "with which a crest presses the wall together")),
       needed(keys::number("speed_mm_s", 0.1, 200, "with which waves run there"))}};
  return shape;
}

const Shape& wave() {
  static const Shape shape{
      "waves",
      "Peristalsis of a hollow organ: rings of contraction that run along it. From one to the next it is speed over "
      "frequency.",
      {needed(keys::name("solid", "the organ: a solid that is not cuttable")),
       keys::points("centreline_mm", -kFar, kFar, 2,
                    "along the lumen, in the waves' direction, default: the centres of the solid's sections"),
       needed(keys::objects("stations", wave_station, 1, "by rising s_mm")),
       needed(keys::number("per_minute", 0.1, 60, "waves that begin")),
       keys::number("width_mm", 1, 100, "sigma of a wave's Gaussian profile, default 10"),
       keys::number("first_s", 0, 36000, "when a crest is at the centre line's beginning, default 0"),
       keys::number("cycle_s", 1, 36000, "the organ is active for a share of this time and rests then, default 60"),
       keys::number("active_share", 0, 1, "that share, default 1: always active")}};
  return shape;
}

const Shape& carried() {
  static const Shape shape{"carried body",
                           "A body whose holders in space go along with the breath.",
                           {needed(keys::name("body", "a solid, strand, membrane or pouch")),
                            keys::number("share", 0, 1, "of the amplitude, default 1")}};
  return shape;
}

const Shape& breathing() {
  static const Shape shape{
      "breathing",
      "What the diaphragm carries goes to and fro; a scene begins at the end of an expiration.",
      {needed(keys::number("per_minute", 1, 60, "breaths")),
       needed(keys::number("amplitude_mm", 0, 50, "from the end of an expiration to that of an inspiration")),
       keys::vec3("direction", -1, 1, "of inspiration, any length, default (0, -1, 0): towards the feet"),
       needed(keys::objects("carries", carried, 1, "bodies that go along"))}};
  return shape;
}

const Shape& detail_level() {
  static const Shape shape{
      "level of detail",
      "What a thing is like from a distance on.",
      {needed(keys::number("from_mm", 1, kFar, "its distance from the endoscope's tip")),
       needed(keys::number("error_mm", 0.001, 20, "by which its surface may depart from the full one")),
       keys::integer("surface", 0, 2, "patterns: 2 all, 1 no fine flecks, 0 no vessels either; default 2")}};
  return shape;
}

const Shape& detail() {
  static const Shape shape{
      "detail",
      "How finely things are drawn, by how far off they are. Distances are meant for a picture 600 px high through a "
      "lens "
      "of 70 degrees; in another one a thing changes at the same size. The physics knows nothing of it.",
      {needed(keys::texts("of",
                          "bodies, walls, instruments, ports (for their sleeves), cavity, endoscope, arteries, veins")),
       needed(keys::objects("levels", detail_level, 0, "by rising from_mm; none: always in full"))}};
  return shape;
}

Shape file_shape(std::string name, std::string meaning, std::vector<Key> keys) {
  Shape shape{std::move(name), std::move(meaning), std::move(keys)};
  shape.keys.insert(shape.keys.begin(),
                    {keys::text("$schema", "where editors find this kind of file's schema"), keys::format(1)});
  return shape;
}

}  // namespace

const Shape& scene_shape() {
  static const Shape shape =
      file_shape("scene", "Organs, instruments and where they stand.",
                 {needed(keys::name("name", "what exercises call it")), keys::text("title", "one line for people"),
                  keys::vec3("gravity_m_s2", -100, 100, "in the patient's frame, default (0, 0, -9.81)"),
                  needed(keys::includes("tissues", tissue_row, "materials: tables in files, or rows")),
                  needed(keys::includes("organs", organ, "organs: files or objects")),
                  keys::includes("vessels", vessels_shape, "arteries and veins: files or objects"),
                  keys::object("fluids", fluids, "drops and a pool, default none"),
                  keys::object("bleeder", bleeder, "a vessel that opens by itself, default none"),
                  keys::object("energy", energy, "current and heat, default none"),
                  keys::objects("peristalsis", wave, 0, "waves of hollow organs, default none"),
                  keys::object("breathing", breathing, "default none"),
                  keys::objects("detail", detail, 0, "how finely things are drawn, default: as far as one sees it"),
                  needed(keys::includes("instruments", instrument, "instruments: files or objects")),
                  needed(keys::objects("ports", port, 1, "trocars")),
                  needed(keys::objects("tools", tool, 0, "in the order of the hands: left, right, assistant")),
                  needed(keys::object("scope", scope, "the endoscope"))});
  return shape;
}

const Shape& organ_shape() {
  static const Shape shape =
      file_shape("organ file", "Bodies that belong together, in the scene's frame.", organ_keys());
  return shape;
}

const Shape& instrument_shape() {
  static const Shape shape = file_shape("instrument file", "An instrument's shape and grip.", instrument_keys());
  return shape;
}

const Shape& tissue_shape() {
  static const Shape shape = file_shape("tissue table", "Materials.",
                                        {needed(keys::objects("tissues", tissue_row, 1, "one row per material"))});
  return shape;
}

}  // namespace trocar::scene
