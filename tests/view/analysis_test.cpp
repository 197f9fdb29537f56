// The analysis view: known strains, forces and pressures get the colours of the legend; the scales can be read with
// every kind of colour vision; nothing of it changes the State.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/render/backend/backend.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/view/analysis/analysis_drawing.hpp>
#include <trocar/view/analysis/surface_strain.hpp>
#include <trocar/view/scene/scene_view.hpp>

#include "../sim/small_scene.hpp"
#include "pelvis.hpp"

namespace trocar::view {
namespace {

// --- scales ---

double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

/// A colour as somebody without long-wave (protan) or middle-wave (deutan) cones sees it [Vienot et al. 1999].
Colour seen_by(bool protan, Colour c) {
  const double r = linear(double(c.r)), g = linear(double(c.g)), b = linear(double(c.b));
  double l = 17.8824 * r + 43.5161 * g + 4.11935 * b, m = 3.45565 * r + 27.1554 * g + 3.86714 * b;
  const double s = 0.0299566 * r + 0.184309 * g + 1.46709 * b;
  if (protan)
    l = 2.02344 * m - 2.52581 * s;
  else
    m = 0.494207 * l + 1.24827 * s;
  return {float(std::clamp(0.0809444479 * l - 0.130504409 * m + 0.116721066 * s, 0.0, 1.0)),
          float(std::clamp(-0.0102485335 * l + 0.0540193266 * m - 0.113614708 * s, 0.0, 1.0)),
          float(std::clamp(-0.000365296938 * l - 0.00412161469 * m + 0.693511405 * s, 0.0, 1.0))};
}
double apart(Colour a, Colour b) {
  return std::hypot(double(a.r) - double(b.r), double(a.g) - double(b.g), double(a.b) - double(b.b));
}

TEST(ColourScale, LightnessFallsFromTheMiddleOfTheDivergingScaleToBothEnds) {
  for (const double side : {-1.0, 1.0})
    for (int i = 1; i <= 20; ++i)
      EXPECT_LT(lightness_of(colour_on(Scale::diverging, side * i / 20)),
                lightness_of(colour_on(Scale::diverging, side * (i - 1) / 20)))
          << side * i / 20;
}

TEST(ColourScale, LightnessRisesAlongTheSequentialScale) {
  for (int i = 1; i <= 20; ++i)
    EXPECT_GT(lightness_of(colour_on(Scale::sequential, i / 20.0)),
              lightness_of(colour_on(Scale::sequential, (i - 1) / 20.0)))
        << i;
}

TEST(ColourScale, SidesOfTheDivergingScaleStayApartForTheColourBlind) {
  for (const bool protan : {true, false})
    for (const double size : {0.3, 0.5, 0.75, 1.0}) {
      const Colour low = seen_by(protan, colour_on(Scale::diverging, -size)),
                   high = seen_by(protan, colour_on(Scale::diverging, size));
      EXPECT_GT(apart(low, high), 0.12) << (protan ? "protan " : "deutan ") << size;
      EXPECT_GT(double(low.b), double(high.b)) << "the blue side stays the bluer one";
    }
}

TEST(ColourScale, GoesOnWithItsEndsAndTakesWhatIsNoNumber) {
  EXPECT_EQ(apart(colour_on(Scale::diverging, 7), colour_on(Scale::diverging, 1)), 0);
  EXPECT_EQ(apart(colour_on(Scale::diverging, -7), colour_on(Scale::diverging, -1)), 0);
  EXPECT_EQ(apart(colour_on(Scale::sequential, std::nan("")), colour_on(Scale::sequential, 0)), 0);
}

// --- figures ---

std::array<Vec3f, 3> stretched(double x, double y) {
  return {Vec3f{0, 0, 1}, Vec3f{float(0.01 * x), 0, 1}, Vec3f{float(0.004 * x), float(0.008 * y), 1}};
}

TEST(SurfaceStrain, IsTheLargestStretchWhicheverWayTheTriangleLies) {
  const auto drawn = stretched(1, 1);
  EXPECT_NEAR(triangle_strain(drawn, drawn), 0, 1e-6);
  EXPECT_NEAR(triangle_strain(drawn, stretched(1.1, 1)), 0.1, 1e-5);
  EXPECT_NEAR(triangle_strain(drawn, stretched(1, 0.8)), -0.2, 1e-5);
  EXPECT_NEAR(triangle_strain(drawn, stretched(1.1, 0.95)), 0.1, 1e-5);
  auto turned = stretched(1.1, 1);
  for (Vec3f& p : turned) p = {p.z, p.x, p.y};
  EXPECT_NEAR(triangle_strain(drawn, turned), 0.1, 1e-5) << "turning is no strain";
  EXPECT_EQ(triangle_strain({}, drawn), 0) << "drawn without area";
}

/// The small scene's cord, stretched along itself to (1 + strain) of its rest lengths.
sim::State with_stretched_cord(double strain) {
  sim::State state = sim::initial_state(small::model());
  tissue::StrandState& cord = state.strands[small::kCord];
  const tissue::StrandModel& model = small::model().strand_bodies[small::kCord].model;
  for (std::size_t i = 1; i < cord.x.size(); ++i)
    cord.x[i] = cord.x[i - 1] + Vec3d{(1 + strain) * model.rest_length[i - 1], 0, 0};
  return state;
}

bool painted_as(render::Paint p, Colour c) { return p == paint_shown_as(c); }

TEST(Analysis, AStrandThatIsStretchedByTenPercentHasTheColourOfTenPercent) {
  const auto backend = render::make_null_backend();
  const sim::State state = with_stretched_cord(0.10);
  AnalysisOptions options;
  options.strain_range = 0.2;
  const Colour ten_percent = colour_on(Scale::diverging, 0.5);
  StrainSurfaces surfaces(small::model());
  surfaces.update(state, options, *backend);
  SpringLines springs(small::model());
  springs.update(state, options, *backend);
  for (const FalseColourMesh* mesh : {&surfaces.strands()[small::kCord], &springs.strands()[small::kCord]}) {
    ASSERT_TRUE(mesh->there());
    for (std::size_t v = 0; v < mesh->value.size(); ++v) {
      ASSERT_NEAR(mesh->value[v], 0.10, 1e-5);
      ASSERT_TRUE(painted_as(mesh->buffer.paint[v], ten_percent));
    }
  }
  EXPECT_FALSE(painted_as(paint_shown_as(ten_percent), colour_on(Scale::diverging, 0.45)));
}

TEST(Analysis, AnotherSolversOutlineThatIsAMillimetreAwayColoursTheOrganWithOneMillimetre) {
  const auto backend = render::make_null_backend();
  const sim::Model& model = small::model();
  const tissue::Skin &drawn = model.solids[1].fine, &touched = model.solids[1].skin;
  OrganBeside beside{1, drawn.rest, touched.rest};
  for (Vec3f& p : beside.skin) p.z += 0.001f;
  for (Vec3f& p : beside.outline) p.z += 0.001f;
  AnalysisOptions options;
  options.apart_most = 0.004;
  SolverOutline outline(model);
  const auto wires_from = [&](float height) {
    outline.update(sim::initial_state(model), beside, options, {0.05f, 0, height}, *backend);
    return outline.wires().buffer.indices.size();
  };
  const std::size_t near = wires_from(0.06f);
  ASSERT_TRUE(outline.surface().there() && outline.wires().there());
  for (std::size_t v = 0; v < outline.surface().value.size(); ++v) {
    ASSERT_NEAR(outline.surface().value[v], 0.001f, 1e-5f);
    ASSERT_TRUE(painted_as(outline.surface().buffer.paint[v], colour_on(Scale::sequential, 0.25)));
  }
  EXPECT_LT(wires_from(1.0f), near / 2) << "from afar the silhouette alone";
}

TEST(Analysis, AnOrganThatIsStretchedAsAWholeHasThatStrainEverywhere) {
  const auto backend = render::make_null_backend();
  sim::State state = sim::initial_state(small::model());
  for (tissue::NodeState& n : state.solids[0].nodes) n.x *= 1.08f;  // from its origin, along x
  StrainSurfaces surfaces(small::model());
  surfaces.update(state, {}, *backend);
  const FalseColourMesh& organ = surfaces.organs()[0];
  for (const float strain : organ.value) EXPECT_LT(std::fabs(strain), 0.0802f);
  const float most = *std::max_element(organ.value.begin(), organ.value.end());
  EXPECT_NEAR(most, 0.08, 1e-3);
  const sim::State start = sim::initial_state(small::model());
  surfaces.update(start, {}, *backend);
  for (const float strain : surfaces.organs()[0].value) EXPECT_NEAR(strain, 0, 1e-3) << "as drawn";
}

TEST(Analysis, SpringsThatAreCutAreNotShown) {
  const auto backend = render::make_null_backend();
  sim::State state = sim::initial_state(small::model());
  SpringLines springs(small::model());
  springs.update(state, {}, *backend);
  const std::size_t organ = springs.organs()[0].value.size(), cord = springs.strands()[small::kCord].value.size();
  EXPECT_EQ(organ, 2 * std::size_t(small::model().solids[0].network.springs));
  tissue::cut_spring(small::model().solids[0].network, state.solids[0], 3);
  tissue::cut_element(state.strands[small::kCord], 2);
  springs.update(state, {}, *backend);
  EXPECT_EQ(springs.organs()[0].value.size(), organ - 2);
  EXPECT_EQ(springs.strands()[small::kCord].value.size(), cord - 2);
}

TEST(Analysis, ABodyThatCanBeCutShowsItsEdgesAgainstTheirDrawnLengths) {
  const auto backend = render::make_null_backend();
  sim::State state = sim::initial_state(small::model());
  SpringLines springs(small::model());
  springs.update(state, {}, *backend);
  for (const float strain : springs.organs()[small::kBar].value) EXPECT_NEAR(strain, 0, 1e-3);
  for (tissue::NodeState& n : state.cuttables[0].nodes) n.x *= 1.2f, n.y *= 1.2f, n.z *= 1.2f;
  springs.update(state, {}, *backend);
  for (const float strain : springs.organs()[small::kBar].value) EXPECT_NEAR(strain, 0.2, 1e-3);
}

TEST(Analysis, AnArrowOfAGripIsAsLongAsTheForceThatItsHoldsExert) {
  sim::State state = sim::initial_state(small::model());
  interactions::ToolState& tool = state.tools[small::kGrasper];
  tool.holds = 2;
  for (int i = 0; i < 2; ++i) {
    tool.hold[i].at.body = BodyId::strand(small::kTube);
    tool.hold[i].force[2] = 0.75f;
  }
  const std::vector<ForceArrow> arrows = forces_of(small::model(), state);
  const auto grip = std::find_if(arrows.begin(), arrows.end(), [](const auto& a) { return a.kind == ForceKind::grip; });
  ASSERT_NE(grip, arrows.end());
  EXPECT_EQ(grip->hand, small::kGrasper);
  EXPECT_NEAR(grip->force.z, 1.5, 1e-6);
  const auto [tail, tip] = ends_of(*grip, 0.010);
  EXPECT_NEAR(tip.z - tail.z, 0.015, 1e-9);
  EXPECT_NEAR(length(tail - grip->at), 0, 1e-12) << "what pulls begins at the tissue";
  const auto trocar =
      std::find_if(arrows.begin(), arrows.end(), [](const auto& a) { return a.kind == ForceKind::trocar; });
  EXPECT_EQ(trocar, arrows.end()) << "a pull along the shaft is the hand's alone";
}

TEST(Analysis, APressedPointHasAnArrowThatEndsThere) {
  sim::State state = sim::initial_state(small::model());
  interactions::TouchBook& book = state.touches[small::kGrasper];
  book.count = 2;
  for (int i = 0; i < 2; ++i) {
    book.touch[i].part = interactions::kJawA;
    book.touch[i].anchored = 1;
    book.touch[i].force = i == 0 ? 0.4f : 0.001f;
    book.touch[i].normal[2] = -1;
  }
  const std::vector<ForceArrow> arrows = forces_of(small::model(), state);
  ASSERT_EQ(arrows.size(), 1u) << "what is hardly touched has none";
  const auto [tail, tip] = ends_of(arrows[0], 0.010);
  EXPECT_NEAR(length(tip - arrows[0].at), 0, 1e-12);
  EXPECT_NEAR(tail.z - tip.z, 0.004, 1e-9);
  EXPECT_LT(length(ends_of({ForceKind::grip, {}, {0, 0, 500}, 0}, 0.010)[1]), kLongestArrow + 1e-9);
}

TEST(Analysis, AVesselHasTheColourOfItsPressure) {
  const auto backend = render::make_null_backend();
  sim::State state = sim::initial_state(small::model());
  for (double& p : state.flow.p) p = 60 * vessels::kPascalPerMmHg;
  for (double& q : state.flow.q) q = 0;
  VesselDrawing seen(small::model(), false, *backend);
  VesselDrawing whole(small::model(), false, *backend, {}, VesselDrawing::Lie::below_too);
  whole.update(state), seen.update(state);
  ASSERT_EQ(whole.pressures().size(), whole.buffer().positions.size());
  for (const float p : whole.pressures()) EXPECT_NEAR(double(p) / vessels::kPascalPerMmHg, 60, 0.5);
  EXPECT_GE(whole.pressures().size(), seen.pressures().size());
  const Colour half = colour_of_pressure({}, 60 * vessels::kPascalPerMmHg);
  EXPECT_EQ(apart(half, colour_on(Scale::sequential, 0.5)), 0);
}

// --- the view ---

ViewOptions all_of_it(ViewOptions::Camera camera) {
  ViewOptions options;
  options.camera = camera;
  options.analysis.springs = options.analysis.strain = options.analysis.forces = options.analysis.pressure = true;
  return options;
}

TEST(AnalysisView, EveryChoiceIsDrawableWithEveryCameraAndLeavesTheStateAlone) {
  const auto backend = render::make_null_backend();
  SceneView view(bleeding(), *backend);
  sim::State state = sim::initial_state(bleeding());
  sim::Work work = sim::make_work(bleeding());
  sim::Input input = bleeding().start;
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 40; ++i) sim::step(bleeding(), input, state, work);
    for (auto& tool : input.tools) tool.handle = 1;
    const std::uint64_t before = sim::hash_of(state);
    for (const auto camera : {ViewOptions::Camera::scope, ViewOptions::Camera::inside, ViewOptions::Camera::outside})
      for (int choice = 1; choice < 16; ++choice) {
        ViewOptions options = all_of_it(camera);
        options.analysis.springs = choice & 1, options.analysis.strain = choice & 2;
        options.analysis.forces = choice & 4, options.analysis.pressure = choice & 8;
        ASSERT_NO_THROW(render::draw_frame(*backend, view.frame(state, options), kTarget)) << choice;
      }
    ASSERT_EQ(sim::hash_of(state), before);
    if (round == 1) tissue::cut_element(state.strands[0], 3);
  }
}

TEST(AnalysisView, NothingButFiguresHasColour) {
  const auto backend = render::make_null_backend();
  SceneView view(bleeding(), *backend);
  const render::Frame frame = view.frame(sim::initial_state(bleeding()), all_of_it(ViewOptions::Camera::outside));
  for (const render::DrawItem& i : frame.items) {
    if (i.material.shading != render::Shading::tissue) continue;
    EXPECT_NEAR(i.material.colour.x, i.material.colour.z, 0.02f);
    EXPECT_EQ(i.material.vessels, 0);
  }
  EXPECT_TRUE(frame.liquid.empty());
  EXPECT_FALSE(frame.look.auto_exposure);
}

TEST(AnalysisView, HiddenPartsAreHiddenHereToo) {
  const auto backend = render::make_null_backend();
  SceneView view(bleeding(), *backend);
  ViewOptions options = all_of_it(ViewOptions::Camera::outside);
  const sim::State state = sim::initial_state(bleeding());
  const std::size_t before = view.frame(state, options).items.size();
  options.styles.assign(view.parts().size(), PartStyle::shaded);
  for (std::size_t i = 0; i < view.parts().size(); ++i)
    if (view.parts()[i].name == bleeding().organ_name(0)) options.styles[i] = PartStyle::hidden;
  EXPECT_EQ(view.frame(state, options).items.size(), before - 2) << "its surface and its springs";
}

/// What the camera makes of paint is what the legend says: a square that fills the picture.
TEST(AnalysisPictures, PaintIsShownAsTheColourOfTheLegend) {
  const auto context = render::GlContext::off_screen();
  const auto backend = render::make_gl_backend(*context);
  for (const double strain : {-1.0, -0.6, -0.3, 0.0, 0.3, 0.6, 1.0})
    for (const bool lit : {false, true}) {
      const Colour wanted = colour_on(Scale::diverging, strain);
      MeshBuffer square;
      for (const Vec3f p : {Vec3f{-1, -1, -0.5f}, Vec3f{1, -1, -0.5f}, Vec3f{1, 1, -0.5f}, Vec3f{-1, 1, -0.5f}})
        square.add(p, paint_shown_as(wanted));
      square.quad(0, 1, 2, 3);
      const OwnedMesh mesh(*backend, square.data());
      render::Frame frame;
      frame.look = analysis_look();
      frame.light = light_for_analysis();
      frame.items.resize(1);
      frame.items[0].mesh = mesh.handle();
      frame.items[0].material.wetness = 0;
      frame.items[0].material.shading = lit ? render::Shading::vertex_colour : render::Shading::unlit;
      render::draw_frame(*backend, frame, kTarget);
      const render::Image image = backend->read_pixels();
      const std::uint8_t* middle = image.at(32, 24);
      const double off = 8;  // of 255; paint has eight bits, which are coarse in the dark
      EXPECT_NEAR(middle[0], 255 * double(wanted.r), off) << strain << (lit ? " lit" : "");
      EXPECT_NEAR(middle[1], 255 * double(wanted.g), off) << strain << (lit ? " lit" : "");
      EXPECT_NEAR(middle[2], 255 * double(wanted.b), off) << strain << (lit ? " lit" : "");
    }
}

TEST(AnalysisLegend, SaysEveryQuantityThatIsShownWithItsUnit) {
  AnalysisOptions o;
  EXPECT_TRUE(legend_of(o).bars.empty() && legend_of(o).keys.empty());
  o.strain = o.forces = o.pressure = true;
  o.strain_range = 0.3;
  const Legend legend = legend_of(o);
  ASSERT_EQ(legend.bars.size(), 2u);
  EXPECT_NE(legend.bars[0].title.find("[%]"), std::string::npos);
  EXPECT_EQ(legend.bars[0].ticks.front(), "-30");
  EXPECT_EQ(legend.bars[0].ticks.back(), "+30");
  EXPECT_EQ(apart(legend.bars[0].colours.back(), colour_of_strain(o, 0.3)), 0);
  EXPECT_NE(legend.bars[1].title.find("[mmHg]"), std::string::npos);
  ASSERT_EQ(legend.keys.size(), 3u);
  for (const Legend::Key& k : legend.keys) EXPECT_NE(k.text.find("mm/N"), std::string::npos);
  AnalysisOptions solvers;
  solvers.solvers = true;
  EXPECT_NE(legend_of(solvers).bars.at(0).title.find("[mm]"), std::string::npos);
  EXPECT_EQ(legend_of(solvers).bars.at(0).ticks.back(), "2");
  EXPECT_EQ(legend_of(solvers).keys.size(), 1u);
}

}  // namespace
}  // namespace trocar::view
