// The drawn scene against the rules of the renderer (the null backend refuses NaN, bad indices, wrong sizes) and
// against anatomy: tubes stay closed, fimbriae move with their tube, metal lies where the simulation has it.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/interactions/verbs/irrigate.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/sim/verbs/heat_bodies.hpp>
#include <trocar/view/anatomy/fat_tags.hpp>
#include <trocar/view/base/heat_marks.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/bodies/fimbria.hpp>
#include <trocar/view/bodies/organ_drawing.hpp>
#include <trocar/view/bodies/sheet_drawing.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>
#include <trocar/view/fluids/wet_drawing.hpp>
#include <trocar/view/instruments/clip_shape.hpp>
#include <trocar/view/instruments/instrument_shapes.hpp>
#include <trocar/view/instruments/port_site.hpp>
#include <trocar/view/scene/scene_view.hpp>

#include "pelvis.hpp"

namespace trocar::view {
namespace {

void expect_drawable(SceneView& view, render::Backend& backend, const sim::State& state) {
  for (const auto camera : {ViewOptions::Camera::scope, ViewOptions::Camera::outside}) {
    ViewOptions options;
    options.camera = camera;
    EXPECT_NO_THROW(render::draw_frame(backend, view.frame(state, options), kTarget));
  }
}

const sim::Model& loop_box() {
  static const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/box_loop/scene.json"));
  return model;
}

int left_tube() { return pelvis().strand_index("tube_left"); }

void cut(sim::State& state, int strand, double s, double fraction = 1) {
  interactions::Cut& c = state.cuts[std::size_t(state.cut_count++)];
  c.strand = strand;
  c.s = s;
  c.fraction = fraction;
  if (fraction < 1) return;
  tissue::cut_element(state.strands[std::size_t(strand)],
                      place_at(pelvis().strand_bodies[std::size_t(strand)], s).element);
}

void clip(sim::State& state, int strand, double s, double cover = 1) {
  interactions::Clip& c = state.clips[std::size_t(state.clip_count++)];
  c.strand = strand;
  c.s = s;
  c.cover = cover;
  c.opening[1] = 1;
  c.axis[2] = 1;
  c.reach = 0.004;
  c.length = 0.0085;
  c.tool = 0;
}

geometry::TriMesh welded(const MeshBuffer& b) {
  geometry::TriMesh mesh;
  for (const Vec3f& p : b.positions) mesh.positions.push_back(vec_cast<double>(p));
  for (std::size_t i = 0; i + 2 < b.indices.size(); i += 3)
    mesh.triangles.push_back({int(b.indices[i]), int(b.indices[i + 1]), int(b.indices[i + 2])});
  return geometry::merged_vertices(mesh, 1e-7);
}

/// Vertices of the fingers: the last ones of the tube's mesh.
std::span<const Vec3f> fingers_of(const TubeDrawing& tube) {
  FimbriaSite site;
  site.radius = 0.004;
  const std::size_t n = fimbriae(site).size();
  return std::span(tube.buffer().positions).last(n);
}

TEST(SceneView, EveryFrameIsDrawableFromStartToEnd) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  sim::State state = sim::initial_state(pelvis());
  expect_drawable(view, *backend, state);
  clip(state, left_tube(), 0.016);
  clip(state, left_tube(), 0.030, 0.5);
  expect_drawable(view, *backend, state);
  cut(state, left_tube(), 0.010, 0.6);
  cut(state, left_tube(), 0.0231);
  expect_drawable(view, *backend, state);
  cut(state, left_tube(), 0.0255);  // the next element: one node between two cuts
  cut(state, left_tube(), 0.0002);
  cut(state, left_tube(), pelvis().strand_bodies[std::size_t(left_tube())].length() - 0.0002);
  expect_drawable(view, *backend, state);
  expect_drawable(view, *backend, sim::initial_state(pelvis()));  // a replay that starts again
}

TEST(SceneView, ExtremeDeformationIsDrawable) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  sim::State state = sim::initial_state(pelvis());
  for (tissue::StrandState& strand : state.strands)
    for (std::size_t i = 0; i < strand.x.size(); ++i)
      strand.x[i] += 0.05 * Vec3d{varied(int(i), 1) - 0.5, varied(int(i), 2) - 0.5, varied(int(i), 3) - 0.5};
  for (tissue::NetworkState& solid : state.solids)
    for (std::size_t i = 0; i < solid.nodes.size(); ++i) solid.nodes[i].x += float(0.03 * varied(int(i), 4));
  cut(state, left_tube(), 0.03);
  clip(state, left_tube(), 0.02);
  expect_drawable(view, *backend, state);
  for (tissue::StrandState& strand : state.strands)
    for (Vec3d& x : strand.x) x = Vec3d{0.01, -0.1, -0.1};  // all nodes in one point
  for (tissue::NetworkState& solid : state.solids)
    for (tissue::NodeState& node : solid.nodes) node.x = node.y = node.z = 0;
  expect_drawable(view, *backend, state);
}

TEST(SceneView, MeshesStayConstantOverAThousandFrames) {
  auto backend = render::make_null_backend();
  {
    SceneView view(pelvis(), *backend);
    sim::State state = sim::initial_state(pelvis());
    render::draw_frame(*backend, view.frame(state, {}), kTarget);
    const render::BackendStats first = backend->stats();
    const std::size_t items = view.frame(state, {}).items.size();
    for (int i = 0; i < 1000; ++i) {
      ++state.tick;
      state.strands[std::size_t(left_tube())].x[5].z += 1e-6;
      ASSERT_EQ(view.frame(state, {}).items.size(), items);
    }
    render::draw_frame(*backend, view.frame(state, {}), kTarget);
    EXPECT_EQ(backend->stats().meshes_alive, first.meshes_alive);
    EXPECT_EQ(backend->stats().triangles, 2 * first.triangles);
  }
  EXPECT_EQ(backend->stats().meshes_alive, 0u);
}

TEST(SceneView, TheScopesConeFillsTheMask) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  const sim::State state = sim::initial_state(pelvis());
  const render::Frame frame = view.frame(state, {});
  const kinematics::ScopeFrame scope = sim::scope_of(pelvis(), state);
  EXPECT_FLOAT_EQ(frame.camera.vertical_fov, float(pelvis().scope.field_of_view));
  EXPECT_FLOAT_EQ(frame.look.mask_diameter, 1);
  EXPECT_LT(length(vec_cast<double>(frame.camera.position) - scope.eye), 1e-6);
  EXPECT_LT(length(vec_cast<double>(frame.camera.rotation.column(2)) + scope.forward), 1e-5);
  EXPECT_LT(length(vec_cast<double>(frame.camera.rotation.column(1)) - scope.up), 1e-5);
}

TEST(SceneView, EveryItemIsOfAPartThatHasANameAndAGroup) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  std::set<std::uint16_t> seen;
  for (const render::DrawItem& item : view.frame(sim::initial_state(pelvis()), {}).items) {
    ASSERT_GE(item.part, 1);
    ASSERT_LE(item.part, view.parts().size());
    seen.insert(item.part);
  }
  std::set<std::string> names;
  for (const ScenePart& part : view.parts()) names.insert(part.name);
  EXPECT_EQ(names.size(), view.parts().size()) << "no name twice";
  for (std::size_t i = 0; i < view.parts().size(); ++i) {
    const ScenePart& part = view.parts()[i];
    const bool later = part.name == "endoscope" || part.name == "clips" || part.group == PartGroup::fluids;
    EXPECT_EQ(seen.count(std::uint16_t(i + 1)), later ? 0u : 1u) << part.name;
  }
}

TEST(SceneView, PartsAreHiddenTransparentOrEdgesAsChosen) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  const sim::State state = sim::initial_state(pelvis());
  ViewOptions options;
  for (const ScenePart& part : view.parts())
    options.styles.push_back(part.group == PartGroup::organs  ? PartStyle::wireframe
                             : part.group == PartGroup::tubes ? PartStyle::transparent
                             : part.group == PartGroup::walls ? PartStyle::hidden
                                                              : PartStyle::shaded);
  const render::Frame frame = view.frame(state, options);
  EXPECT_LT(frame.items.size(), view.frame(state, {}).items.size());
  for (const render::DrawItem& item : frame.items) {
    const PartGroup group = view.parts()[item.part - std::size_t(1)].group;
    EXPECT_NE(group, PartGroup::walls);
    EXPECT_EQ(item.style, group == PartGroup::organs  ? render::DrawStyle::wireframe
                          : group == PartGroup::tubes ? render::DrawStyle::transparent
                                                      : render::DrawStyle::shaded);
  }
  EXPECT_FALSE(frame.rods.empty());
  for (std::size_t i = 0; i < view.parts().size(); ++i)
    if (view.parts()[i].group == PartGroup::instruments) options.styles[i] = PartStyle::hidden;
  EXPECT_TRUE(view.frame(state, options).rods.empty()) << "what is not shown casts no shadow";
}

TEST(SceneView, WithoutInstrumentsNoMetalIsDrawn) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  ViewOptions options;
  options.instruments = false;
  for (const render::DrawItem& item : view.frame(sim::initial_state(pelvis()), options).items)
    EXPECT_NE(item.material.shading, render::Shading::metal);
}

TEST(SceneView, AClipIsDrawnOnItsHostAndADroppedOneIsNot) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  sim::State state = sim::initial_state(pelvis());
  const std::size_t before = view.frame(state, {}).items.size();
  clip(state, -1, 0);
  EXPECT_EQ(view.frame(state, {}).items.size(), before);
  clip(state, left_tube(), 0.02);
  const render::Frame frame = view.frame(state, {});
  ASSERT_EQ(frame.items.size(), before + 1);
  const interactions::StrandBody& body = pelvis().strand_bodies[std::size_t(left_tube())];
  const Vec3d host = point_at(body, state.strands[std::size_t(left_tube())], place_at(body, 0.02));
  const Vec3d eye = vec_cast<double>(frame.camera.position), to_eye = normalised(eye - host);
  double aside = 1, nearer = 0;  // of the metal that lies most nearly on the line from the host to the eye
  for (const render::DrawItem& item : frame.items) {
    if (item.material.shading != render::Shading::metal) continue;
    const auto& m = item.transform.m;
    const Vec3d off = Vec3d{m[12], m[13], m[14]} + 0.004 * Vec3d{m[8], m[9], m[10]} - host;
    if (length(off) > 0.005 || length(off - dot(off, to_eye) * to_eye) > aside) continue;
    aside = length(off - dot(off, to_eye) * to_eye);
    nearer = dot(off, to_eye);
  }
  EXPECT_LT(aside, 2e-4);
  EXPECT_GT(nearer, 0.0005) << "no fold beside the tube lies over it";
  EXPECT_LT(nearer, 0.002);
}

TEST(TubeDrawing, EveryStrandsSurfaceIsClosedAndFacesOut) {
  for (int i = 0; i < int(pelvis().strands.size()); ++i) {
    const TubeDrawing tube(pelvis(), i);
    const geometry::TriMesh mesh = welded(tube.drawn());
    EXPECT_TRUE(geometry::check_edges(mesh).closed()) << pelvis().strands[std::size_t(i)].name;
    EXPECT_GT(geometry::volume(mesh), 0);
  }
}

TEST(TubeDrawing, BothStumpsOfACutAreClosedAndEndAtTheCut) {
  auto backend = render::make_null_backend();
  TubeDrawing tube(pelvis(), left_tube());
  tube.create(std::vector<Paint>(tube.drawn().positions.size()), *backend);
  sim::State state = sim::initial_state(pelvis());
  cut(state, left_tube(), 0.0231);
  tissue::StrandState& strand = state.strands[std::size_t(left_tube())];
  const int element = place_at(pelvis().strand_bodies[std::size_t(left_tube())], 0.0231).element;
  for (std::size_t i = std::size_t(element) + 1; i < strand.x.size(); ++i) strand.x[i].x += 0.02;
  tube.update(state);
  const geometry::TriMesh mesh = welded(tube.buffer());
  EXPECT_TRUE(geometry::check_edges(mesh).closed());
  const interactions::StrandBody& body = pelvis().strand_bodies[std::size_t(left_tube())];
  const auto pieces = pieces_of(body, strand.alive, {state.cuts.data(), 1}, left_tube());
  ASSERT_EQ(pieces.size(), 2u);
  const StrandCurve curve(body, strand, pieces);
  const Vec3d low = curve.at(0, 0.0231).point, high = curve.at(1, 0.0231).point, middle = 0.5 * (low + high);
  double to_low = 1, to_high = 1, to_middle = 1;
  for (const Vec3f& f : tube.buffer().positions) {
    const Vec3d p = vec_cast<double>(f);
    to_low = std::min(to_low, length(p - low));
    to_high = std::min(to_high, length(p - high));
    to_middle = std::min(to_middle, length(p - middle));
  }
  EXPECT_LT(to_low, 0.001);  // a face there
  EXPECT_LT(to_high, 0.001);
  EXPECT_GT(to_middle, 0.5 * length(high - low) - 0.0025);  // and nothing between
}

TEST(TubeDrawing, FimbriaeMoveRigidlyWithTheTubesEnd) {
  auto backend = render::make_null_backend();
  TubeDrawing tube(pelvis(), left_tube());
  tube.create(std::vector<Paint>(tube.drawn().positions.size()), *backend);
  sim::State state = sim::initial_state(pelvis());
  tube.update(state);
  const auto before_span = fingers_of(tube);
  const std::vector<Vec3f> before(before_span.begin(), before_span.end());
  tissue::StrandState& strand = state.strands[std::size_t(left_tube())];
  const std::size_t n = strand.x.size();
  const Vec3d pivot = strand.x[n - 6];
  for (std::size_t i = n - 5; i < n; ++i) {  // the end turned by 40 degrees about z
    const Vec3d d = strand.x[i] - pivot;
    strand.x[i] = pivot + Vec3d{0.766 * d.x - 0.6428 * d.y, 0.6428 * d.x + 0.766 * d.y, d.z};
  }
  tube.update(state);
  const auto after = fingers_of(tube);
  double moved = 0;
  for (std::size_t i = 0; i < before.size(); i += 7) {
    moved = std::max(moved, double(length(after[i] - before[i])));
    for (std::size_t k = i + 1; k < before.size(); k += 13)
      ASSERT_NEAR(length(after[i] - after[k]), length(before[i] - before[k]), 2e-6f);
  }
  EXPECT_GT(moved, 0.004);
}

TEST(TubeDrawing, AClipFlattensTheTubeBetweenItsLegs) {
  auto backend = render::make_null_backend();
  TubeDrawing tube(pelvis(), left_tube());
  tube.create(std::vector<Paint>(tube.drawn().positions.size()), *backend);
  sim::State state = sim::initial_state(pelvis());
  clip(state, left_tube(), 0.02);
  tube.update(state);
  const ClipPress press = press_of(state.clips[0], pelvis(), state);
  int between = 0;
  for (const Vec3f& p : tube.buffer().positions) {
    const Vec3d d = vec_cast<double>(p) - press.centre;
    if (std::fabs(dot(d, press.normal)) > 0.4 * kClipLegWidth || length(d) > 0.004) continue;
    ++between;
    EXPECT_LT(std::fabs(dot(d, press.open)), 1.4 * kClipHalfGap);
  }
  EXPECT_GT(between, 10);
}

TEST(TubeDrawing, RestCoordinatesDoNotMoveWhenTheTubeIsCut) {
  auto backend = render::make_null_backend();
  TubeDrawing tube(pelvis(), left_tube());
  tube.create(std::vector<Paint>(tube.drawn().positions.size()), *backend);
  const MeshBuffer whole = tube.drawn();
  sim::State state = sim::initial_state(pelvis());
  cut(state, left_tube(), 0.0231);
  for (Vec3d& x : state.strands[std::size_t(left_tube())].x) x.z += 0.01;
  tube.update(state);
  // Every rest vertex of the cut tube lies on the drawn, uncut one (to the distance between its rings).
  for (const Vec3f& p : tube.buffer().rest) {
    float nearest = 1;
    for (const Vec3f& q : whole.positions) nearest = std::min(nearest, length(p - q));
    ASSERT_LT(nearest, 0.0025f);
  }
}

TEST(SheetDrawing, TheFoldHangsOnItsTubeAndSplitsWhereThatIsCut) {
  ASSERT_FALSE(pelvis().drawn_folds.empty());
  auto backend = render::make_null_backend();
  const int strand = pelvis().drawn_folds[0].strand;
  SheetDrawing sheet(pelvis(), 0, *backend);
  sim::State state = sim::initial_state(pelvis());
  sheet.update(state);
  const MeshBuffer before = sheet.buffer();
  for (Vec3d& x : state.strands[std::size_t(strand)].x) x.z += 0.01;
  sheet.update(state);
  ASSERT_EQ(sheet.buffer().positions.size(), before.positions.size());
  EXPECT_NEAR(sheet.buffer().positions[0].z - before.positions[0].z, 0.01f, 0.002f);  // on the tube
  const std::size_t base = before.positions.size() - 1;
  EXPECT_LT(length(sheet.buffer().positions[base] - before.positions[base]), 1e-4f);  // on the base line
  const double middle = 0.5 * (pelvis().drawn_folds[0].from + pelvis().drawn_folds[0].to);
  cut(state, strand, middle);
  sheet.update(state);
  EXPECT_GT(geometry::check_edges(welded(sheet.buffer())).open, geometry::check_edges(welded(before)).open - 1);
  EXPECT_NO_THROW(sheet.update(sim::initial_state(pelvis())));
}

TEST(OrganDrawing, ShowsTheSkinAsTheNodesCarryIt) {
  auto backend = render::make_null_backend();
  const sim::SolidModel& solid = pelvis().solids[0];
  OrganDrawing organ(solid, {}, std::vector<Paint>(solid.fine.rest.size()), *backend);
  tissue::NetworkState state = tissue::rest_state(solid.network);
  organ.update(state);
  const std::uint64_t uploaded = backend->stats().vertices_uploaded;
  organ.update(state);
  EXPECT_EQ(backend->stats().vertices_uploaded, uploaded);  // nothing moved, nothing sent
  for (tissue::NodeState& n : state.nodes) n.x += 0.01f;
  organ.update(state);
  EXPECT_EQ(backend->stats().vertices_uploaded, uploaded + solid.fine.rest.size());
}

TEST(FatTags, HangOnTheBowelAndMoveWithIt) {
  auto backend = render::make_null_backend();
  const auto& solids = pelvis().solids;
  const auto bowel = std::find_if(solids.begin(), solids.end(), [](const auto& s) { return s.look == "bowel"; });
  ASSERT_NE(bowel, solids.end());
  OrganDrawing organ(*bowel, {}, std::vector<Paint>(bowel->fine.rest.size()), *backend);
  FatTags tags(organ, *bowel, 6, pelvis().gravity, *backend);
  ASSERT_FALSE(tags.buffer().positions.empty());
  EXPECT_TRUE(geometry::check_edges(welded(tags.buffer())).closed());
  tissue::NetworkState state = tissue::rest_state(bowel->network);
  organ.update(state);
  tags.update(organ);
  const std::vector<Vec3f> before = tags.buffer().positions;
  for (tissue::NodeState& n : state.nodes) n.y += 0.004f;
  organ.update(state);
  tags.update(organ);
  for (std::size_t i = 0; i < before.size(); ++i)
    ASSERT_LT(length(tags.buffer().positions[i] - before[i] - Vec3f{0, 0.004f, 0}), 2e-5f);
}

TEST(OrganDrawing, ACutOpensTheSkinIntoAClosedWound) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  sim::State state = sim::initial_state(pelvis());
  render::draw_frame(*backend, view.frame(state, {}), kTarget);
  const std::uint64_t before = backend->stats().triangles;
  for (std::size_t t = 40; t < 60; ++t) state.parted[0][t] = 1;
  render::draw_frame(*backend, view.frame(state, {}), kTarget);
  const std::uint64_t open = backend->stats().triangles - before;
  EXPECT_GT(open, before);  // walls have come
  for (tissue::NodeState& n : state.solids[0].nodes) n.x += 0.001f;
  render::draw_frame(*backend, view.frame(state, {}), kTarget);
  render::draw_frame(*backend, view.frame(sim::initial_state(pelvis()), {}), kTarget);
  EXPECT_EQ(backend->stats().triangles, 2 * before + 2 * open);  // and go when the attempt starts again
}

TEST(HeatMarks, BurnFromPaleOverTanToBlack) {
  tissue::HeatReading r;
  EXPECT_EQ(burn_of(r), 0);
  r.coagulated = 1;
  EXPECT_EQ(burn_of(r), 100);
  r.peak = 95;
  EXPECT_EQ(burn_of(r), 180);
  r.peak = 250;
  EXPECT_EQ(burn_of(r), 255);
}

TEST(HeatMarks, WhatIsCoagulatedIsBurntThereAndNowhereElse) {
  const sim::Model& m = bleeding();
  sim::State state = sim::initial_state(m);
  const int uterus = m.organ_index("uterus");
  const tissue::Skin& skin = m.skin(uterus);
  HeatMarks marks(m, BodyId::organ(std::size_t(uterus)), below_skin(skin));
  EXPECT_FALSE(marks.update(state));
  const Vec3d at = vec_cast<double>(skin.rest[0]);
  tissue::HeatSource source;
  source.body = BodyId::organ(std::size_t(uterus));
  source.a = source.b = at;
  source.radius = 1.5e-3;
  source.watts = 20;
  tissue::HeatWork work = tissue::make_work(m.energy.heat);
  for (int i = 0; i < 2000; ++i) tissue::advance(m.energy.heat, {&source, 1}, sim::tissue_shape(m), state.heat, work);
  EXPECT_TRUE(marks.update(state));
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    const double away = length(vec_cast<double>(skin.rest[i]) - at);
    if (away < 1e-3) {
      EXPECT_GE(marks.burn(i), 90) << i;
    }
    if (away > 8e-3) {
      EXPECT_LE(marks.burn(i), 1) << i;
    }
  }
}

TEST(SceneView, AHeatedSceneIsDrawable) {
  const sim::Model& m = bleeding();
  const auto backend = render::make_null_backend();
  SceneView view(m, *backend);
  sim::State state = sim::initial_state(m);
  sim::Work work = sim::make_work(m);
  sim::Input input = m.start;
  input.pedals = sim::kBlue;
  for (int i = 0; i < 20; ++i) sim::step(m, input, state, work);
  expect_drawable(view, *backend, state);
}

/// Share of the brightness that varies across the view.
double contrast(const render::Image& image) {
  double sum = 0, squares = 0, n = 0;
  for (int y = 30; y < 90; ++y)
    for (int x = 50; x < 110; ++x) {
      const double light = image.at(x, y)[0] + image.at(x, y)[1] + image.at(x, y)[2];
      sum += light, squares += light * light, n += 1;
    }
  return std::sqrt(std::max(squares / n - sum * sum / (n * n), 0.0)) / (sum / n);
}

/// Volume of a film's splat as the renderer adds it up: height (1 - r^2)^2, r in reaches, by midpoints [m^3].
double held_by(const render::Splat& s) {
  const double reach = double(render::kSplatReach) * double(s.radius), half = 0.5 * double(length(s.to - s.from));
  constexpr int kCells = 200;
  const double step_x = 2 * (half + reach) / kCells, step_y = 2 * reach / kCells;
  double sum = 0;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const double along = std::max(std::fabs((i + 0.5) * step_x - half - reach) - half, 0.0);
      const double off = (j + 0.5) * step_y - reach;
      const double r = std::max(1 - (along * along + off * off) / (reach * reach), 0.0);
      sum += r * r;
    }
  return sum * step_x * step_y * double(s.height);
}

TEST(SceneView, AFoggedLensIsTheScopesAndNoOtherCameras) {
  const sim::Model& m = bleeding();
  const auto backend = render::make_null_backend();
  SceneView view(m, *backend);
  sim::State state = sim::initial_state(m);
  ViewOptions scope, outside, beside;
  outside.camera = ViewOptions::Camera::outside;
  beside.camera = ViewOptions::Camera::inside;
  EXPECT_TRUE(view.frame(state, scope).look.soil.clean());
  state.fluids.smoke.fog = 0.6;
  for (const int eye : {0, 1}) {
    scope.eye_index = eye;
    EXPECT_FLOAT_EQ(view.frame(state, scope).look.soil.fog, 0.6f) << "either eye of a pair";
  }
  EXPECT_TRUE(view.frame(state, outside).look.soil.clean());
  EXPECT_TRUE(view.frame(state, beside).look.soil.clean());
  state.fluids.smoke.wipe_left = 7;
  EXPECT_GT(view.frame(state, scope).look.soil.wipe, 0);
  state.fluids.smoke.fog = state.fluids.smoke.wipe_left = 0;
  state.tick = 60'000;
  EXPECT_TRUE(view.frame(state, scope).look.soil.clean()) << "a minute after a wipe";
}

TEST(SceneView, AFoggedLensTakesContrastAndAWipedOneGivesThePictureBack) {
  std::unique_ptr<render::GlContext> context;
  try {
    context = render::GlContext::off_screen();
  } catch (const core::EnvironmentLacks&) {
    GTEST_SKIP() << "no OpenGL here";
  }
  const sim::Model& m = bleeding();
  const auto backend = render::make_gl_backend(*context);
  SceneView view(m, *backend);
  sim::State state = sim::initial_state(m);
  const auto drawn = [&](int eye) {  // each with an exposure memory of its own
    ViewOptions options;
    options.eye_index = eye;
    for (int i = 0; i < 3; ++i) draw_frame(*backend, view.frame(state, options), render::Target::off_screen(160, 120));
    return backend->read_pixels();
  };
  const render::Image clear = drawn(0);
  state.fluids.smoke.fog = 0.5;
  const render::Image fogged = drawn(1);
  state.fluids.smoke.fog = 0;
  const render::Image wiped = drawn(2);
  std::printf("    contrast %.3f, fogged %.3f\n", contrast(clear), contrast(fogged));
  EXPECT_LT(contrast(fogged), 0.75 * contrast(clear));
  EXPECT_EQ(wiped.rgb, clear.rgb);
}

TEST(WetDrawing, AFilmIsDrawnOverItsPlacesOwnAreaAndHoldsWhatLiesThere) {
  const sim::Model& m = bleeding();
  sim::State state = sim::initial_state(m);
  WetDrawing wet(m);
  int listed = 0;
  for (std::size_t i = 0; i < state.fluids.droplets.film.size(); i += 97) {
    state.fluids.droplets.film.assign(state.fluids.droplets.film.size(), {});
    state.fluids.droplets.film[i] = {300'000, 0, 0};
    render::Frame frame;
    wet.list(state, frame);
    for (const render::Splat& s : frame.liquid.splats) {
      ++listed;
      ASSERT_EQ(s.kind, render::SplatKind::film);
      EXPECT_NEAR(held_by(s), 300e-12, 0.02 * 300e-12) << i;
    }
  }
  EXPECT_GT(listed, 20);
}

TEST(WetDrawing, BloodDarkensAsItClotsWhereItLies) {
  const sim::Model& m = bleeding();
  sim::State state = sim::initial_state(m);
  WetDrawing wet(m);
  const auto darkest = [&] {
    render::Frame frame;
    wet.list(state, frame);
    float most = 0;
    for (const render::Splat& s : frame.liquid.splats) most = std::max(most, s.dark);
    for (const render::SheetVertex& v : frame.liquid.sheet) most = std::max(most, v.dark);
    return most;
  };
  for (std::size_t i = 0; i < 500; ++i) state.fluids.droplets.film[i] = {300'000, 0, 0};
  EXPECT_EQ(darkest(), 0);
  state.fluids.droplets.tick = 240'000;
  EXPECT_NEAR(darkest(), 0.5f, 0.01f) << "four minutes old";
  for (fluids::Blood& blood : state.fluids.droplets.film_blood) blood.born = 240;
  EXPECT_EQ(darkest(), 0) << "as old as the blood in it";
  const fluids::PoolModel& pool = m.wet.model.pool;
  for (int j = 50; j < 70; ++j)
    for (int i = 50; i < 70; ++i) pour(pool, i, j, {.blood = 5 * fluids::kMicrolitre}, state.fluids.pool);
  EXPECT_NEAR(darkest(), 0.5f, 0.01f) << "the pool's is four minutes old";
}

TEST(InstrumentShapes, JawsMeetAtTheTipWhenClosedAndStandApartWhenOpen) {
  for (const sim::HandModel& hand : pelvis().hands)
    for (const interactions::ToolModel& tool : hand.rack) {
      kinematics::FulcrumPose pose;
      pose.depth = 0.1;
      for (const double aperture : {0.0, 1.0}) {
        const interactions::ToolShape shape = shape_of(tool, pose, aperture);
        const Placement a = placement_of(InstrumentPart::Joint::jaw_a, shape);
        const Placement b = placement_of(InstrumentPart::Joint::jaw_b, shape);
        const Vec3f tip{0, 0, float(tool.jaw_length)};
        const Vec3f gap = a.rotation * tip + a.translation - (b.rotation * tip + b.translation);
        const double expected = 2 * shape.half_gap + 2 * tool.jaw_length * std::sin(shape.half_angle);
        EXPECT_NEAR(double(length(gap)), expected, 1e-5) << tool.name;
        if (aperture > 0) continue;
        EXPECT_LT(length(a.rotation * tip + a.translation - vec_cast<float>(shape.frame.tip)), 1e-5f);
      }
    }
}

TEST(InstrumentShapes, PartsStayWithinTheirTrocarAndFaceOut) {
  for (const sim::HandModel& hand : bleeding().hands)
    for (const interactions::ToolModel& tool : hand.rack)
      for (const InstrumentPart& part : instrument_parts(tool)) {
        EXPECT_NE(look(pelvis(), part.look).name, "neutral") << part.look;
        const geometry::TriMesh mesh = welded(part.mesh);
        EXPECT_GT(geometry::volume(mesh), 0) << tool.name;
        for (const Vec3f& p : part.mesh.positions) {
          EXPECT_LE(p.z, float(tool.jaw_length + 0.5 * tool.jaw_thickness) + 1e-6f) << tool.name;  // round ends
          if (part.joint != InstrumentPart::Joint::body) continue;
          EXPECT_LE(std::hypot(p.x, p.y), 1.06f * float(tool.shaft_radius)) << tool.name;
        }
      }
}

TEST(InstrumentShapes, ASuctionIrrigatorEndsWhereItsBoreDoesAndHasHolesAroundIt) {
  interactions::ToolModel tool;
  tool.kind = interactions::ToolKind::suction_irrigator;
  tool.jaw_length = 0.005;
  tool.jaw_thickness = 0.0025;
  tool.opening = 0;
  const std::vector<InstrumentPart> parts = instrument_parts(tool);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_EQ(look(pelvis(), parts[0].look).name, "matte_steel");
  const interactions::ToolShape shape = shape_of(tool, {0, 0, 0, 0.1}, 0);
  const double end = to_jaw(shape, bore_of(tool, shape, shape, 1e-3).end).z;
  float most = 0;
  int dark_outside = 0;
  for (std::size_t i = 0; i < parts[0].mesh.positions.size(); ++i) {
    const Vec3f p = parts[0].mesh.positions[i];
    most = std::max(most, p.z);
    dark_outside += std::hypot(p.x, p.y) > float(tool.shaft_radius) && parts[0].mesh.paint[i].openness < 128;
  }
  EXPECT_NEAR(double(most), end, 1e-6);
  EXPECT_GE(dark_outside, 8 * 16);
}

TEST(InstrumentShapes, ADissectorsJawsBendTheSameWayAndMeetWhereStraightOnesWould) {
  interactions::ToolModel tool;
  tool.kind = interactions::ToolKind::dissector;
  tool.jaw_length = 0.020;
  tool.jaw_width = 0.003;
  tool.jaw_thickness = 0.0016;
  const interactions::ToolShape shape = shape_of(tool, {0, 0, 0, 0.1}, 0);
  for (const InstrumentPart& part : instrument_parts(tool)) {
    EXPECT_GT(geometry::volume(welded(part.mesh)), 0) << "it faces out";
    if (part.joint == InstrumentPart::Joint::body) continue;
    const Placement place = placement_of(part.joint, shape);
    double least = 1, most = -1, tip = 0, end = 0;
    for (const Vec3f& p : part.mesh.positions) {
      const Vec3d at = to_jaw(shape, vec_cast<double>(place.rotation * p + place.translation));
      least = std::min(least, at.y), most = std::max(most, at.y);
      if (at.z > 0.0195) tip = std::max(tip, std::fabs(at.y));
      end = std::max(end, at.z);
      EXPECT_LT(std::fabs(at.y), 0.0012 + 0.0015) << "no further from the rod that touches than a clip is wide";
    }
    EXPECT_GT(-least, most + 0.0005) << "both to one side";
    EXPECT_NEAR(end, tool.jaw_length, 1e-5);
    EXPECT_LE(tip, 0.0012);
  }
}

/// Does the ray along +x or -x through (y, z) of the jaw's frame meet the mesh?
bool covers(const MeshBuffer& mesh, double y, double z) {
  for (std::size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
    double side[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f a = mesh.positions[mesh.indices[t + k]], b = mesh.positions[mesh.indices[t + (k + 1) % 3]];
      side[k] = double(b.y - a.y) * (z - double(a.z)) - double(b.z - a.z) * (y - double(a.y));
    }
    if ((side[0] > 0 && side[1] > 0 && side[2] > 0) || (side[0] < 0 && side[1] < 0 && side[2] < 0)) return true;
  }
  return false;
}

const interactions::ToolModel& tool_of(interactions::ToolKind kind) {
  for (const sim::HandModel& hand : bleeding().hands)
    for (const interactions::ToolModel& tool : hand.rack)
      if (tool.kind == kind) return tool;
  throw std::logic_error("no such instrument");
}

TEST(InstrumentShapes, OneSeesThroughAGraspersJawsButNotThroughBipolarPaddles) {
  for (const auto& [kind, through] :
       {std::pair{interactions::ToolKind::grasper, true}, std::pair{interactions::ToolKind::bipolar, false}}) {
    const interactions::ToolModel& tool = tool_of(kind);
    bool covered = false;
    for (const InstrumentPart& part : instrument_parts(tool))
      if (part.joint == InstrumentPart::Joint::jaw_a)
        covered = covered || covers(part.mesh, 1e-5, 0.6 * tool.jaw_length);
    EXPECT_EQ(covered, !through) << tool.name;
  }
}

TEST(InstrumentShapes, ElectrodesAreHeldByWhiteInsulators) {
  for (const auto kind : {interactions::ToolKind::hook, interactions::ToolKind::bipolar}) {
    const std::vector<InstrumentPart> parts = instrument_parts(tool_of(kind));
    EXPECT_TRUE(std::any_of(parts.begin(), parts.end(), [](const InstrumentPart& p) { return p.look == "ceramic"; }));
  }
  const Vec3f white = look(pelvis(), "ceramic").material.colour;
  EXPECT_GT(std::min({white.x, white.y, white.z}), 0.5f);
}

TEST(InstrumentShapes, JawsInTheirSleeveFitIntoIt) {
  for (const sim::HandModel& hand : bleeding().hands)
    for (const interactions::ToolModel& tool : hand.rack)
      for (const double beyond : {-0.01, 0.0, 0.006, 0.012, 0.05}) {
        const double aperture = std::min(1.0, aperture_in_sleeve(tool, beyond, tool.shaft_radius));
        if (beyond <= 0) {
          EXPECT_EQ(aperture, 1) << tool.name;
        }
        const interactions::ToolShape shape = shape_of(tool, {0, 0, 0, 0.1}, aperture);
        const Placement body = placement_of(InstrumentPart::Joint::body, shape);
        for (const InstrumentPart& part : instrument_parts(tool)) {
          const Placement place = part.joint == InstrumentPart::Joint::works
                                      ? placement_of_works(tool, shape, part.link, aperture)
                                      : placement_of(part.joint, shape);
          for (const Vec3f& p : part.mesh.positions) {
            const Vec3f off = place.rotation * p + place.translation - body.translation;
            const float along = dot(off, body.rotation.column(2));
            if (double(along) > beyond) continue;
            EXPECT_LT(length(off - along * body.rotation.column(2)), float(tool.shaft_radius + kSleeveWall))
                << tool.name << " " << beyond;
          }
        }
      }
}

/// A flat wall of 80 mm, z = 0, its inside below.
struct FlatWall {
  std::vector<Vec3f> positions{{-0.04f, -0.04f, 0}, {0.04f, -0.04f, 0}, {0.04f, 0.04f, 0}, {-0.04f, 0.04f, 0}};
  std::vector<std::uint32_t> indices{0, 2, 1, 0, 3, 2};
  std::vector<PiercedWall> walls{{positions, {}, indices, "peritoneum"}};
};

TEST(PortSite, ATentRisesAlongTheSleeveAndEndsInTheWall) {
  auto backend = render::make_null_backend();
  const FlatWall wall;
  const Vec3d port{0, 0, 0.01};
  constexpr double radius = 0.0034;
  PortSite site(port, normalised(Vec3d{0.2, 0, -1}), radius, wall.walls, *backend);
  ASSERT_NE(site.mesh().id, 0u);
  EXPECT_NEAR(site.depth(), 0.01 * std::sqrt(1.04), 1e-6);
  for (const Vec3d way : {Vec3d{0.2, 0, -1}, Vec3d{-0.1, 0.7, -1}, Vec3d{0, -1, -1}}) {
    const Vec3d axis = normalised(way);
    site.update(axis);
    double highest = 0, lowest = 1, nearest = 1;
    for (const Vec3f& q : site.buffer().positions) {
      const Vec3d p = vec_cast<double>(q), off = p - port;
      highest = std::max(highest, -p.z);
      if (length(Vec3d{p.x, p.y, 0}) > 0.014) lowest = std::min(lowest, -p.z);
      if (-p.z > 0.0015) nearest = std::min(nearest, length(off - dot(off, axis) * axis));
    }
    EXPECT_GT(highest, 0.003);
    EXPECT_LT(highest, 0.012);
    EXPECT_LE(lowest, 0) << "the border lies under the wall: no step shows";
    EXPECT_GT(lowest, -0.0004);
    EXPECT_GT(nearest, 0.9 * radius) << "nothing of it lies in the sleeve";
  }
}

TEST(PortSite, ATentStandsBeforeItsWallHoweverTheSleeveLeans) {
  auto backend = render::make_null_backend();
  const FlatWall wall;
  const Vec3d port{0, 0, 0.01};
  PortSite site(port, {0, 0, -1}, 0.0034, wall.walls, *backend);
  for (const double lean : {0.0, 0.5, 1.0, 2.0})
    for (const double turn : {0.0, 1.0, 2.5, 4.0}) {
      site.update(normalised(Vec3d{lean * std::cos(turn), lean * std::sin(turn), -1}));
      for (std::size_t i = 0; i < site.buffer().positions.size(); ++i) {
        if (site.buffer().paint[i].openness < 30) continue;  // within the slit
        const Vec3f p = site.buffer().positions[i];
        EXPECT_GT(-p.z, length(Vec3f{p.x, p.y, 0}) < 0.012f ? 0.0f : -0.0004f) << lean << ' ' << turn;
      }
    }
}

TEST(PortSite, WithoutAWallNothingIsDrawn) {
  auto backend = render::make_null_backend();
  const FlatWall wall;
  EXPECT_EQ(PortSite({0, 0, 0.2}, {0, 0, -1}, 0.003, wall.walls, *backend).mesh().id, 0u) << "too far off";
  EXPECT_EQ(PortSite({0.1, 0, 0.01}, {0, 0, -1}, 0.003, wall.walls, *backend).mesh().id, 0u) << "beside it";
}

TEST(SceneView, ABoxReturnsItsOwnLightAndTissuePink) {
  auto backend = render::make_null_backend();
  const auto returned = [&](const sim::Model& model) {
    SceneView view(model, *backend);
    return view.frame(sim::initial_state(model), {}).light.bounce_colour;
  };
  const Vec3f body = returned(pelvis()), box = returned(loop_box());
  EXPECT_GT(body.x, 2 * body.y);
  EXPECT_LT(box.x, box.y);  // its board is bluish grey
  EXPECT_LT(box.y, box.z);
  const Vec3f share{0.2126f, 0.7152f, 0.0722f};
  EXPECT_NEAR(dot(box, share), dot(body, share), 1e-4f);
}

TEST(SceneView, ABoxDoesNotSoilInstruments) {
  auto backend = render::make_null_backend();
  SceneView view(loop_box(), *backend);
  int metal = 0;
  for (const render::DrawItem& item : view.frame(sim::initial_state(loop_box()), {}).items) {
    if (item.material.shading != render::Shading::metal) continue;
    ++metal;
    EXPECT_EQ(item.material.soil, 0);
  }
  EXPECT_GT(metal, 3);
}

TEST(SceneView, WorkSoilsInstruments) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  sim::State state = sim::initial_state(pelvis());
  const auto soil = [&] {
    float most = 0;
    for (const render::DrawItem& item : view.frame(state, {}).items)
      if (item.material.shading == render::Shading::metal) most = std::max(most, item.material.soil);
    return most;
  };
  const float before = soil();
  cut(state, left_tube(), 0.0231);
  EXPECT_GT(soil(), before);
  EXPECT_LE(soil(), 1);
}

TEST(ClipShape, HasTheSameVerticesOpenAndClosed) {
  const MeshBuffer open = clip_shape(0.0085, 0.006), closed = clip_shape(0.0085, 0);
  EXPECT_EQ(open.positions.size(), closed.positions.size());
  EXPECT_EQ(open.indices, closed.indices);
  EXPECT_TRUE(geometry::check_edges(welded(closed)).closed());
  float length_of = 0, half = 0;
  for (const Vec3f& p : closed.positions) {
    length_of = std::max(length_of, p.z);
    half = std::max(half, std::fabs(p.x));
  }
  EXPECT_NEAR(length_of, 0.0085f, 0.0004f);
  EXPECT_LT(half, 0.0016f);
}

TEST(ClipShape, AnOpenOneIsAChevronWhoseLegsLieInTheJaws) {
  constexpr double kGap = 0.006;
  float narrowest = 1, at_bend = 0;
  for (const Vec3f& p : clip_shape(0.0085, kGap).positions) {
    if (p.z > 0.005f && p.z < 0.008f) narrowest = std::min(narrowest, std::fabs(p.x));
    if (p.z < 0.0002f) at_bend = std::max(at_bend, std::fabs(p.x));
  }
  EXPECT_NEAR(narrowest, kClipHalfGap + 0.5 * kGap, 1e-5);
  EXPECT_LT(at_bend, 0.0012f) << "no eye stands out there";
}

TEST(ClipShape, IsGroovedOnItsInnerSidesAndSmoothOutside) {
  const MeshBuffer closed = clip_shape(0.0085, 0);
  std::map<float, std::pair<float, float>> across;  // of a leg, by height: nearest to and farthest from the middle
  for (const Vec3f& p : closed.positions) {
    if (p.x < 0 || p.z < 0.003f || p.z > 0.0082f) continue;  // its tips are bevelled
    auto& [in, out] = across.try_emplace(std::round(1e5f * p.z), 1.0f, 0.0f).first->second;
    in = std::min(in, p.x);
    out = std::max(out, p.x);
  }
  float least_in = 1, most_in = 0, least_out = 1, most_out = 0;
  for (const auto& [z, span] : across) {
    least_in = std::min(least_in, span.first), most_in = std::max(most_in, span.first);
    least_out = std::min(least_out, span.second), most_out = std::max(most_out, span.second);
  }
  EXPECT_GT(most_in - least_in, 0.0001f);
  EXPECT_NEAR(most_out, least_out, 0.00002f);
}

TEST(Looks, EveryLookOfTheScenesIsKnown) {
  const auto known = [](const std::string& name) { return look(pelvis(), name).name == name; };
  for (const sim::SolidModel& s : pelvis().solids) EXPECT_TRUE(known(s.look)) << s.look;
  for (const sim::StrandAnatomy& s : pelvis().strands) EXPECT_TRUE(known(s.look)) << s.look;
  for (const sim::WallModel& w : pelvis().walls) EXPECT_TRUE(known(w.look)) << w.look;
  for (const sim::DrawnFold& s : pelvis().drawn_folds) EXPECT_TRUE(known(s.look)) << s.look;
}

TEST(Looks, MaterialsAreWhatTheFilesSay) {
  const render::Material& liver = look(pelvis(), "liver").material;
  EXPECT_EQ(liver.colour, render::srgb(74, 42, 46));
  EXPECT_EQ(liver.vessel_colour, render::srgb(150, 106, 110));
  EXPECT_EQ(liver.film_size, 0.0013f);
  EXPECT_EQ(look(pelvis(), "uterus").material.vessel_colour, render::Material{}.vessel_colour) << "not said: as usual";
  EXPECT_EQ(look(pelvis(), "uterus").relief.lopsided, 0.0019);
  EXPECT_EQ(look(pelvis(), "bowel").count(Look::Generator::fat_tags), 18);
  EXPECT_FALSE(look(pelvis(), "uterus").has(Look::Generator::drape));
}

TEST(Looks, AModelWithoutAMaterialLibraryIsNeutralAllOver) {
  const sim::Model bare;
  EXPECT_EQ(look(bare, "liver").name, "neutral");
  EXPECT_EQ(all_looks(bare).size(), 1u);
}

TEST(Looks, AnUnknownNameIsANeutralTissue) { EXPECT_EQ(look(pelvis(), "no such look").name, "neutral"); }

TEST(Looks, TissuesAreRedderThanGreenAndNotGreenButForBileShiningThrough) {
  for (const Look& l : all_looks(pelvis())) {
    const bool of_a_box = l.moulded || l.name == std::string("board");
    const bool of_a_bag = l.name == std::string("bag_film") || l.name == std::string("plastic_sleeve");
    const bool of_a_suture = std::string(l.name).starts_with("thread_");
    if (l.material.shading != render::Shading::tissue || of_a_box || of_a_bag || of_a_suture ||
        l.name == std::string("gallbladder"))
      continue;
    for (const Vec3f& c : {l.material.colour, l.material.colour_b, l.material.colour_c, l.material.tint}) {
      EXPECT_GT(c.x, c.y) << l.name;
      EXPECT_TRUE(c.x > c.z || l.name == std::string("vein")) << l.name;  // veins shine bluish through their walls
    }
  }
}

}  // namespace
}  // namespace trocar::view
