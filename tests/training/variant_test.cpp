// Two arteries to one gallbladder: exercises take the second for a cord, it bleeds when it is cut and does not when it
// was clipped, and whoever missed it is told so. And limits of patients whose duct or artery is another.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/interactions/bodies/strand_body.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/exercise.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/fat.hpp>
#include <trocar/training/observe/sampling.hpp>

namespace trocar::training {
namespace {

const std::string kVariantScenes = TROCAR_SOURCE_DIR "/scenes/";

scene::Description patient(const std::string& scene, const char* variant) {
  scene::Description d = scene::read_scene(kVariantScenes + scene + "/scene.json");
  d.variant = variant;
  scene::vary(d, 0);
  return d;
}

const sim::Model& double_calot() {
  static const sim::Model model = scene::compile(patient("calot", "double_artery"));
  return model;
}

/// Bodies that fat ties the gallbladder to, but for those of a set of the exercise.
std::size_t not_cords(const sim::Model& model, const sim::State& state, const Set& cords) {
  const auto wall = BodyId::membrane(std::size_t(model.membrane_index("gallbladder")));
  const std::vector<BodyId> to = bridged_from(model, state, wall);
  return std::size_t(std::count_if(to.begin(), to.end(), [&](BodyId body) {
    return std::none_of(cords.elements.begin(), cords.elements.end(), [&](const Element& e) {
      const int strand = model.strand_index(e.name);
      return strand >= 0 && body == BodyId::strand(std::size_t(strand));
    });
  }));
}

/// All fat is gone but what lies within `near` of a strand.
sim::State dissected_to(const sim::Model& model, const char* strand, double near) {
  sim::State state = sim::initial_state(model);
  const interactions::FatBody& body = model.fat.front();
  tissue::FatState& fat = state.fat.front();
  const std::size_t roots = std::size_t(body.roots);
  const std::vector<Vec3d>& line = state.strands[std::size_t(model.strand_index(strand))].x;
  for (int n = 0; n < body.fat.lobules(); ++n) {
    double apart = 1;
    for (const Vec3d& p : line) apart = std::min(apart, length(position(body.fat, fat, n) - p));
    if (apart < near) continue;
    fat.lobules[std::size_t(n)].marks |= tissue::Lobule::kBoiledAway;
    for (int i = 0; i < body.fat.septa(); ++i)
      if (septum_end(body.fat, i, 0) == n || septum_end(body.fat, i, 1) == n)
        tissue::cut_spring(body.fat.network, fat.network, i);
    for (std::size_t i = 0; i < model.bonds[roots].bonds.size(); ++i)
      if (model.bonds[roots].bonds[i].node() == n) state.bonds[roots][i] = {1, interactions::BondState::burnt};
  }
  return state;
}

/// A clip applier and scissors at the second artery, that do the whole work in a few seconds.
class AtSecondArtery {
 public:
  static constexpr std::size_t kScissors = 0, kApplier = 1;

  explicit AtSecondArtery(const sim::Model& model)
      : m_model(model), m_strand(std::size_t(model.strand_index("cystic_artery_second"))), m_input(model.start) {
    for (std::size_t t = 0; t < model.hands.size(); ++t)
      m_tip[t] = kinematics::forward(model.hands[t].port, pose_of(model.start.tools[t])).tip;
  }

  static scene::Description scene_of() {
    scene::Description d = patient("cholecystectomy", "double_artery");
    d.ports.push_back({"beside", {-0.018, 0.112, 0}, 0.010, {}});
    const auto scissors_port =
        std::find_if(d.ports.begin(), d.ports.end(), [](const scene::Port& p) { return p.name == "epigastric"; });
    const Vec3d out_of_the_way = scissors_port->position + 0.03 * Vec3d{-0.25, 0.05, -0.95};
    d.placements = {{"scissors", "epigastric", out_of_the_way, 0, {}},
                    {"clip_applier", "beside", {-0.034, 0.114, -0.060}, 0, {}}};
    return d;
  }

  sim::Input next(const sim::State& s, int t, const std::vector<double>& clips, double cut_at) {
    for (std::size_t i = 0; i < clips.size(); ++i) work(s, kApplier, t - 1500 * int(i), clips[i], 0.0137);
    work(s, kScissors, t - 1500 * int(clips.size()), cut_at, 0.010);
    for (std::size_t i = 0; i < m_model.hands.size(); ++i) {
      const kinematics::FulcrumPose pose = kinematics::inverse(m_model.hands[i].port, m_tip[i], roll(s, i));
      m_input.tools[i] = sim::tool_input(pose, float(m_handle[i]));
    }
    return m_input;
  }

 private:
  void work(const sim::State& s, std::size_t tool, int t, double arc, double inside) {
    if (t < 0 || t >= 1500) return;
    m_arc[tool] = arc;
    if (t < 900) aim(s, tool, arc, inside);
    if (t >= 500 && t < 900) handle(tool, 1, 350);
    if (t >= 900) handle(tool, 0, 250);
    if (t >= 1100) move(tool, m_model.hands[tool].port + 0.03 * Vec3d{-0.25, 0.05, -0.95});
  }
  void move(std::size_t tool, Vec3d to) {
    const Vec3d way = to - m_tip[tool];
    const double far = length(way), most = 0.25 * sim::kTick;
    m_tip[tool] += (far <= most ? 1.0 : most / far) * way;
  }
  void aim(const sim::State& state, std::size_t tool, double s, double inside) {
    const interactions::StrandBody& body = m_model.strand_bodies[m_strand];
    const interactions::ToolModel& t = m_model.placed(tool);
    const Vec3d at = interactions::point_at(body, state.strands[m_strand], interactions::place_at(body, s));
    move(tool, at + (t.jaw_length - inside) * normalised(at - t.port));
  }
  void handle(std::size_t tool, double to, int ticks) {
    m_handle[tool] += std::clamp(to - m_handle[tool], -1.0 / ticks, 1.0 / ticks);
  }
  double roll(const sim::State& state, std::size_t tool) {
    const interactions::StrandBody& body = m_model.strand_bodies[m_strand];
    const Vec3d along = tangent_at(body, state.strands[m_strand], interactions::place_at(body, m_arc[tool]));
    const kinematics::FulcrumPose pose = kinematics::inverse(m_model.hands[tool].port, m_tip[tool], 0);
    double wanted = kinematics::roll_towards(pose, along);
    const double half = portable::pi, now = double(m_input.tools[tool].roll);
    while (wanted - now > 0.5 * half) wanted -= half;
    while (wanted - now < -0.5 * half) wanted += half;
    return now + std::clamp(wanted - now, -0.004, 0.004);
  }

  const sim::Model& m_model;
  std::size_t m_strand;
  sim::Input m_input;
  Vec3d m_tip[sim::kMaxTools];
  double m_handle[sim::kMaxTools] = {};
  double m_arc[sim::kMaxTools] = {0.010, 0.010};
};

struct Outcome {
  bool severed = false;
  int clips = 0;
  double bled_mL = 0, last_mL_min = 0;
  std::vector<std::string> codes;
};

Outcome cut_the_second(const std::vector<double>& clips) {
  static const sim::Model model = scene::compile(AtSecondArtery::scene_of());
  static const Exercise exercise = [] {
    Exercise e = read_exercise(kVariantScenes + "cholecystectomy/clip-and-cut.json");
    e.demonstration = {};
    return e;
  }();
  sim::State s = sim::initial_state(model);
  sim::Work w = sim::make_work(model);
  Scoreboard board(exercise, Mode::assessed);
  Faults faults;
  Rules rules(exercise, &model, 0, board, faults);
  AtSecondArtery hands(model);
  const int cut = 1500 * int(clips.size()), end = cut + 3500;
  Outcome out;
  const int second = model.vessel_index("cystic_second");
  std::int64_t bled = 0, before = 0;  // [pL] by that vessel: blades reach over the first artery, too
  for (int t = 0; t < end; ++t) {
    const sim::Input input = hands.next(s, t, clips, 0.010);
    const sim::StepReport report = sim::step(model, input, s, w);
    for (int i = 0; i < w.bleed_count; ++i)
      if (s.openings[std::size_t(w.bleeds[std::size_t(i)].opening)].vessel == second)
        bled += w.bleeds[std::size_t(i)].picolitres;
    if (t == end - 1000) before = bled;
    rules.tick({model, s}, report);
    if (s.tick % kSampleEvery == 0) rules.sample({model, s}, kSample);
  }
  const auto& alive = s.strands[std::size_t(model.strand_index("cystic_artery_second"))].alive;
  out.severed = std::find(alive.begin(), alive.end(), 0) != alive.end();
  out.clips = s.clip_count;
  out.bled_mL = double(bled) * 1e-9;
  out.last_mL_min = double(bled - before) * 1e-9 * 60;
  for (const ErrorMade& e : board.errors()) out.codes.push_back(e.code);
  return out;
}

bool told(const Outcome& o, const char* code) {
  return std::find(o.codes.begin(), o.codes.end(), code) != o.codes.end();
}

}  // namespace

TEST(Variants, ASecondArteryIsAnElementOfSetsOnlyInPatientsWhoHaveOne) {
  const Exercise e = read_exercise(kVariantScenes + "cholecystectomy/calot.json");
  const sim::Model common = scene::compile(scene::read_scene(kVariantScenes + "calot/scene.json"));
  Faults faults;
  EXPECT_EQ(e.names(&common, 0, faults).set("cords")->elements.size(), 2u);
  EXPECT_EQ(e.names(&double_calot(), 0, faults).set("cords")->elements.size(), 3u);
  EXPECT_EQ(e.names(nullptr, 0, faults).set("cords")->elements.size(), 3u) << "all that the file says is checked";
  EXPECT_TRUE(faults.empty());
}

TEST(Variants, ExercisesFitEveryPatient) {
  for (const auto& [name, scene] : std::vector<std::pair<std::string, std::string>>{
           {"calot", "calot"}, {"operation", "cholecystectomy_operation"}, {"clip-and-cut", "cholecystectomy"}}) {
    const Exercise e = read_exercise(kVariantScenes + "cholecystectomy/" + name + ".json");
    for (const char* variant : {"double_artery", "hump", "low_artery", "low_junction"}) {
      Faults faults;
      check_in_scene(e, scene::compile(patient(scene, variant)), faults);
      for (const core::Fault& f : faults) ADD_FAILURE() << variant << ": " << to_string(f);
    }
  }
}

// "Two structures only" means: links between the gallbladder and the rest = {duct, artery or arteries}.
TEST(Variants, FatAboutTheSecondArteryIsABridgeToACordAndToNothingElse) {
  const Exercise e = read_exercise(kVariantScenes + "cholecystectomy/calot.json");
  Faults faults;
  const Names names = e.names(&double_calot(), 0, faults);
  const sim::State state = dissected_to(double_calot(), "cystic_artery_second", 0.008);
  const auto wall = BodyId::membrane(std::size_t(double_calot().membrane_index("gallbladder")));
  const auto second = BodyId::strand(std::size_t(double_calot().strand_index("cystic_artery_second")));
  const std::vector<BodyId> to = bridged_from(double_calot(), state, wall);
  EXPECT_NE(std::find(to.begin(), to.end(), second), to.end());
  Set two = *names.set("cords");
  two.elements.pop_back();
  EXPECT_EQ(not_cords(double_calot(), state, *names.set("cords")) + 1, not_cords(double_calot(), state, two))
      << "an exercise that knows of two cords only would take it for something else";
}

TEST(Variants, ItLiesInFatAndCanBeBared) {
  const BaredStretch bared(double_calot(), double_calot().strand_index("cystic_artery_second"));
  EXPECT_LT(bared.longest(sim::initial_state(double_calot())), 0.006);
  EXPECT_GT(bared.longest(dissected_to(double_calot(), "cystic_duct", 0.001)), 0.010);
}

TEST(Variants, LimitsAreThoseOfThePatient) {
  const Exercise e = read_exercise(kVariantScenes + "cholecystectomy/clip-and-cut.json");
  const auto of = [&](const char* anatomy, const char* limit) {
    return *find_limit(limits_in(e.limits, anatomy), limit);
  };
  EXPECT_DOUBLE_EQ(of("common", "artery_central_mm").high, 13);
  EXPECT_DOUBLE_EQ(of("hump", "artery_central_mm").high, 5.5) << "its cystic artery is short";
  EXPECT_DOUBLE_EQ(of("low_junction", "duct_near_mm").low, 14) << "beside the common duct for so long";
  EXPECT_DOUBLE_EQ(of("hump", "duct_near_mm").low, 5);
  const sim::Model hump = scene::compile(patient("cholecystectomy", "hump"));
  Faults faults;
  EXPECT_DOUBLE_EQ(e.names(&hump, 0, faults).limit("artery_central_mm")->high, 5.5);
}

TEST(Variants, ASecondArteryThatIsCutWithoutClipsBleedsAndIsTold) {
  const Outcome o = cut_the_second({});
  ASSERT_TRUE(o.severed);
  EXPECT_EQ(o.clips, 0);
  EXPECT_GT(o.last_mL_min, 30) << o.bled_mL << " mL";
  EXPECT_TRUE(told(o, "A2.17"));
  EXPECT_TRUE(told(o, "A2.10"));
}

TEST(Variants, ASecondArteryBetweenClipsDoesNotBleed) {
  const Outcome o = cut_the_second({0.0065, 0.0145});
  ASSERT_TRUE(o.severed);
  ASSERT_EQ(o.clips, 2);
  EXPECT_LT(o.last_mL_min, 0.01);
  EXPECT_FALSE(told(o, "A2.17"));
}

}  // namespace trocar::training
