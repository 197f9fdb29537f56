// Bodies as files for other programs, and what they take in memory.
#include <cmath>
#include <set>

#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/drive/body_memory.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/modeller/drive/export_body.hpp>
#include <trocar/modeller/drive/line_tube.hpp>
#include <trocar/sim/model/bodies.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

constexpr const char* kSkins[] = {".obj", ".stl", ".ply", ".vtk"};

geometry::TriMesh mesh_of(const sim::Model& model, const std::string& name, const std::string& ending) {
  return geometry::read_surfaces(exported(model, name, ending), ending).parts[0].mesh;  // [mm]
}

/// Of round slices along a line [m^3]; where the radius changes, of cones.
double round_volume(const std::vector<Vec3d>& line, const std::vector<double>& radius) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double a = radius[i], b = radius[i + 1];
    sum += M_PI / 3 * (a * a + a * b + b * b) * length(line[i + 1] - line[i]);
  }
  return sum;
}

std::string line_after(const std::string& text, const std::string& head) {
  const std::size_t at = text.find(head) + head.size();
  return text.substr(at, text.find('\n', at) - at);
}

TEST(Export, ATubeAroundALineIsABodyOfItsVolume) {
  std::vector<Vec3d> line;
  std::vector<double> radius;
  for (int i = 0; i <= 60; ++i) {
    const double t = i / 60.0;
    line.push_back({0.05 * std::cos(3 * t), 0.05 * std::sin(3 * t), 0.08 * t * t});
    radius.push_back(0.003 + 0.004 * t);
  }
  line.insert(line.begin() + 7, line[7]), radius.insert(radius.begin() + 7, radius[7]);  // there twice
  const geometry::Diagnosis d = geometry::examine(tube_around(line, radius));
  EXPECT_TRUE(d.is_body());
  EXPECT_EQ(int(d.shells.list.size()), 1);
  EXPECT_NEAR(d.volume / round_volume(line, radius), 1, 2e-3);
}

TEST(Export, ACordAndAVesselAreClosedTubesOfTheirRadius) {
  const Workplace place;
  Document document = begun(place / "scene.json", false, "mine");
  apply(document, "cord", R"({"name": "rope", "tissue": "tube", "radius_mm": 2.5,
    "line_mm": [[-40, -150, -110], [-15, -140, -105], [10, -150, -110], [35, -145, -120]]})");
  apply(document, "vessel_tree", R"({"file": "arteries.json", "name": "arteries", "vessel": "trunk", "radius_mm": 1.6,
    "flow_mL_min": 60, "path_mm": [[-50, -120, -110], [-30, -125, -110], [-10, -120, -115]]})");
  const Built built = build(document);
  ASSERT_TRUE(built.good()) << core::to_string(built.faults.front());
  const sim::Model& model = *built.model;
  ASSERT_EQ(model.strands.size(), 1u);
  const double rope = round_volume(model.strand_bodies[0].model.rest, model.strands[0].outer);
  EXPECT_NEAR(rope, M_PI * 2.5 * 2.5 * model.strand_bodies[0].length() * 1e-6, 0.001 * rope);
  std::vector<Vec3d> line;
  std::vector<double> radius;
  for (const auto& p : model.vessels.list[0].path.points) line.push_back(p.drawn), radius.push_back(p.radius);
  for (const auto& [name, volume] : {std::pair{"rope", rope}, std::pair{"trunk", round_volume(line, radius)}})
    for (const char* ending : kSkins) {
      const geometry::Diagnosis d = geometry::examine(mesh_of(model, name, ending), {.tolerance = 1e-9});
      EXPECT_EQ(d.open_edges(), 0) << name << ending;
      EXPECT_TRUE(d.is_body()) << name << ending;
      EXPECT_NEAR(d.volume * 1e-9 / volume, 1, 0.01) << name << ending;
    }
  const std::string network = exported(model, "rope", ".msh");
  const int nodes = model.strand_bodies[0].nodes();
  EXPECT_EQ(line_after(network, "$Nodes\n"), std::to_string(nodes));
  EXPECT_EQ(line_after(network, "$Elements\n"), std::to_string(nodes - 1));
  EXPECT_EQ(line_after(network, "$Elements\n" + std::to_string(nodes - 1) + "\n"), "1 1 2 1 1 1 2");
}

/// One scene with organs of both kinds, strands, folds, pouches, vessels and walls.
TEST(Export, EveryBodyOfAnOperationIsWrittenInEveryEnding) {
  const Built built = build(Document::open("scenes/cholecystectomy_operation/scene.json"));
  ASSERT_TRUE(built.good()) << core::to_string(built.faults.front());
  std::set<std::string> names;
  sim::visit_bodies(*built.model, [&](auto body) { names.insert(sim::model_of(*built.model, body).name); });
  for (const sim::Vessel& vessel : built.model->vessels.list) names.insert(vessel.name);
  for (const sim::WallModel& wall : built.model->walls) names.insert(wall.name);
  EXPECT_GT(built.model->strands.size(), 0u);
  EXPECT_GT(built.model->vessels.list.size(), 0u);
  EXPECT_GT(built.model->walls.size(), 0u);
  for (const std::string& name : names) {
    const std::size_t triangles = mesh_of(*built.model, name, ".obj").triangles.size();
    EXPECT_GT(triangles, 0u) << name;
    for (const char* ending : kSkins)
      EXPECT_EQ(mesh_of(*built.model, name, ending).triangles.size(), triangles) << name << ending;
    const std::string network = exported(*built.model, name, ".msh");
    EXPECT_GT(std::stoi(line_after(network, "$Nodes\n")), 1) << name;
    EXPECT_GT(std::stoi(line_after(network, "$Elements\n")), 0) << name;
  }
}

TEST(Memory, EveryBodyTellsWhatItTakesAndAFinerOneTakesMore) {
  const auto bytes_at = [](const char* cell) {
    const Workplace place;
    Document document = begun(place / "scene.json", false, "mine");
    apply(
        document, "ellipsoid",
        R"({"name": "ball", "tissue": "uterus", "centre_mm": [10, -150, -110], "half_mm": [15, 25, 12], "cell_mm": )" +
            std::string(cell) + "}");
    const Built built = build(document);
    EXPECT_TRUE(built.good());
    const ReadOut ball = read_outs(built, 0).front();
    // a spring's two nodes and rest length at the least, and a node's place and speed
    EXPECT_GT(ball.bytes, std::size_t(16 * ball.springs + 48 * ball.nodes));
    return ball.bytes;
  };
  EXPECT_GT(bytes_at("3"), bytes_at("5"));
  EXPECT_EQ(memory_in_words(820'400), "820 kB");
  EXPECT_EQ(memory_in_words(1'440'000), "1.4 MB");
  const Built whole = build(Document::open("scenes/cholecystectomy_operation/scene.json"));
  ASSERT_TRUE(whole.good());
  for (const ReadOut& r : read_outs(whole, 0)) EXPECT_GT(r.bytes, 1000u) << r.name;
}

}  // namespace
}  // namespace trocar::modeller
