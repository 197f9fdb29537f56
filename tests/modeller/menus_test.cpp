// Every operation and every command that a menu offers, on documents and scans that have nothing for it: a message
// comes back, never an end of the program.
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/operations/first_organ.hpp>
#include <trocar/modeller/operations/import_preview.hpp>
#include <trocar/modeller/scan/segment_organ.hpp>
#include <trocar/modeller/script/session.hpp>
#include <trocar/scene/json/json_text.hpp>
#include <trocar/volumes/files/volume_writer.hpp>
#include <trocar/volumes/segment/islands.hpp>
#include <trocar/volumes/segment/shape_tools.hpp>
#include <trocar/volumes/segment/threshold.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

/// Values that a dialogue proposes, or a hasty user types.
scene::JsonValue filled(const Operation& operation, const std::string& of) {
  using Type = scene::Key::Type;
  scene::JsonValue out = scene::json_object();
  for (const scene::Key& key : operation.parameters.keys) {
    if (!key.required) continue;
    if (!key.choices.empty())
      scene::put(out, key.name, scene::json_text(key.choices.front()));
    else if (key.type == Type::text || key.type == Type::name)
      scene::put(out, key.name, scene::json_text(key.name == "tissue" ? "uterus" : key.name == "name" ? "one" : of));
    else if (key.type == Type::texts)
      scene::put(out, key.name, scene::json_array({scene::json_text(of)}));
    else if (key.type == Type::vec3)
      scene::put(out, key.name, json("[0, -150, -110]"));
    else if (key.type == Type::points)
      scene::put(out, key.name, json("[[0, -150, -110], [20, -150, -110]]"));
    else if (key.type == Type::flag)
      scene::put(out, key.name, scene::json_flag(true));
    else
      scene::put(out, key.name, scene::json_number(2));
  }
  return out;
}

/// Empty, or why it was refused. Anything but a refusal with words fails the test.
std::string refused(const std::function<void()>& act) {
  try {
    act();
    return {};
  } catch (const core::BadInput& bad) {
    EXPECT_FALSE(bad.faults().empty());
    return bad.what();
  } catch (const core::EnvironmentLacks& lacks) {
    return lacks.what();
  }
}

class EveryOperation : public testing::TestWithParam<bool> {};

TEST_P(EveryOperation, IsDoneOrRefusedWithAMessage) {
  const Workplace place;
  for (const Operation& operation : operations())
    for (const char* of : {"organ", "no such", ""}) {
      Document document =
          GetParam() ? first_organ(place / "scene.json", "Mine") : begun(place / "scene.json", false, "empty");
      const std::string said = refused([&] { modeller::apply(operation, filled(operation, of), "menu", document); });
      EXPECT_TRUE(said.empty() || said.size() > 10) << operation.parameters.name;
      if (document.done() == 0) continue;
      const Built built = build(document);  // whatever it left
      EXPECT_TRUE(built.good() || !built.findings.empty()) << operation.parameters.name;
    }
}
INSTANTIATE_TEST_SUITE_P(OnDocuments, EveryOperation, testing::Bool());

/// Air with a cube of tissue.
fs::path small_scan(const Workplace& place) {
  volumes::Volume v;
  v.grid.size = {20, 20, 20};
  v.grid.spacing = {2, 2, 2};
  v.stored.assign(v.grid.count(), -1000);
  for (int k = 5; k < 15; ++k)
    for (int j = 5; j < 15; ++j)
      for (int i = 5; i < 15; ++i) v.stored[v.grid.index(i, j, k)] = 60;
  volumes::write_volume(place / "scan.nrrd", v);
  return place / "scan.nrrd";
}

TEST(Menus, ToolsOfTheScanTakeAnEmptySegment) {
  const Workplace place;
  Scan scan = Scan::open(small_scan(place));
  const std::uint16_t of = scan.segment("organ");
  const volumes::Volume& v = scan.volume();
  const volumes::Labels& l = scan.labels();
  const volumes::Index3 corner{0, 0, 0};
  EXPECT_EQ(refused([&] {
              scan.change("largest", volumes::largest_kept(v, l, of));
              scan.change("holes", volumes::holes_filled(v, l, of));
              scan.change("smooth", volumes::smoothed(v, l, of, 3, volumes::Smoothing::keeps_volume).change);
              scan.change("between", volumes::filled_between_slices(v, l, of, 2));
              scan.change("margin", volumes::margin_moved(v, l, of, 3));
              scan.change("margin", volumes::margin_moved(v, l, of, -3));
              scan.change("island", volumes::chosen_kept(v, l, of, corner));
              scan.change("grow", volumes::grown(v, l, std::span(&corner, 1), {0, 200}, of));
              scan.change("threshold", volumes::thresholded(v, l, {5000, 6000}, of));
            }),
            "");
  EXPECT_EQ(volumes::millilitres(scan.labels(), of), 0);
}

TEST(Menus, OrganOfAnEmptySegmentIsRefusedInWords) {
  const Workplace place;
  Scan scan = Scan::open(small_scan(place));
  scan.segment("kidney");
  Document document = begun(place / "scene.json", false, "mine");
  OrganWish wish;
  wish.segment = wish.name = "kidney";
  wish.tissue = "liver";
  const std::string said = refused([&] { make_organ(document, scan, wish); });
  EXPECT_NE(said.find("The segment \"kidney\" is empty. Paint, threshold or grow it first."), std::string::npos)
      << said;
  wish.segment = "spleen";
  EXPECT_NE(refused([&] { make_organ(document, scan, wish); }), "");
}

TEST(Menus, OrganOfASegmentIsAttachedAndInView) {
  const Workplace place;
  Scan scan = Scan::open(small_scan(place));
  const std::uint16_t of = scan.segment("liver");
  scan.change("threshold", volumes::thresholded(scan.volume(), scan.labels(), {0, 200}, of));
  Document document = begun(place / "scene.json", false, "mine");
  OrganWish wish;
  wish.segment = wish.name = "liver";
  wish.tissue = "liver";
  wish.attach = true;
  wish.place_mm = [](Vec3d) { return Vec3d{0, -150, -110}; };
  make_organ(document, scan, wish);
  const Built built = build(document);
  EXPECT_TRUE(built.good());
  EXPECT_TRUE(built.findings.empty()) << built.findings.front().words;
}

TEST(Menus, PreviewOfAFileThatIsNoMeshIsRefused) {
  const Workplace place;
  std::ofstream(place / "nonsense.obj") << "hello";
  std::ofstream(place / "nonsense.msh") << "hello";
  EXPECT_NE(refused([&] { preview_of(place / "nonsense.obj"); }), "");
  EXPECT_NE(refused([&] { preview_of(place / "nonsense.msh"); }), "");
  EXPECT_NE(refused([&] { preview_of(place / "none.stl"); }), "");
}

TEST(Menus, EmptySessionRefusesCommandsInWords) {
  Session session;
  for (const Command& command : commands())
    refused([&] { run_step(json("{\"do\": \"" + command.parameters.name + "\"}"), "menu", session); });
}

}  // namespace
}  // namespace trocar::modeller
