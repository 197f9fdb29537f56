#include "commands/checks/check_scene.hpp"

#include <algorithm>
#include <chrono>

#include <fmt/format.h>
#include <malloc.h>

#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/checks/equilibrium_check.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/step.hpp>

#include "commands/progress_notice.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

// Wall time, of what is measured on this machine and no part of the verdict.
constexpr double kTickSeconds = 0.8;  // to time a tick
constexpr double kBodySeconds = 0.1;  // to time a body
constexpr std::uint64_t kStandTicks = 1000;

class Elapsed {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - m_start).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point m_start = Clock::now();
};

std::size_t bytes_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

Json describe(const scene::BodyReport& b) {
  Json out{
      {"name", b.name}, {"kind", b.kind}, {"nodes", b.nodes}, {b.kind == "wall" ? "triangles" : "springs", b.springs}};
  if (b.mass > 0) out["mass_g"] = b.mass * 1000;
  if (b.volume > 0) out["volume_ml"] = b.volume * 1e6;
  if (b.pressure != 0) out["pressure_Pa"] = b.pressure;
  if (b.substeps == 0) return out;  // implicit, or does not move
  out["substeps"] = b.substeps;
  out["dt_ms"] = 1000 * sim::kTick / b.substeps;
  out["dt_limit_ms"] = 1000 * b.dt_limit;
  out["dt_margin"] = b.dt_limit * b.substeps / sim::kTick;
  if (b.dt_printed > 0) out["dt_limit_as_printed_ms"] = 1000 * b.dt_printed;
  if (b.dt_printed_summed > 0) out["dt_limit_as_printed_summed_ms"] = 1000 * b.dt_printed_summed;
  out["residual_mN"] = 1000 * b.residual;
  out["prestrain"] = b.prestrain;
  return out;
}

/// Mean cost of a tick of the scene at rest, on this machine and one thread.
double resting_tick(const sim::Model& model, sim::State& state, sim::Work& work) {
  constexpr int kWarm = 50, kTimed = 200;
  const Elapsed whole;
  for (int i = 0; i < kWarm && whole.seconds() < kTickSeconds / 4; ++i) sim::step(model, model.start, state, work);
  const Elapsed timed;
  int ticks = 0;
  do sim::step(model, model.start, state, work);
  while (++ticks < kTimed && whole.seconds() < kTickSeconds);
  return timed.seconds() / ticks;
}

/// What one body takes by itself: memory of its Model, State and Work, and a tick at rest on this machine.
struct BodyCost {
  std::size_t bytes = 0;
  double seconds = 0;
};
template <class BodyModel, class Advance>
BodyCost cost_of(const BodyModel& model, Advance&& advance) {
  constexpr int kWarm = 20, kTimed = 60;
  const Elapsed whole;
  const std::size_t before = bytes_in_use();
  const BodyModel copy = model;
  auto state = rest_state(copy);
  auto work = make_work(copy);
  BodyCost cost{bytes_in_use() - before, 0};
  for (int i = 0; i < kWarm && whole.seconds() < kBodySeconds / 4; ++i) advance(copy, state, work);
  const Elapsed timed;
  int ticks = 0;
  do advance(copy, state, work);
  while (++ticks < kTimed && whole.seconds() < kBodySeconds);
  cost.seconds = timed.seconds() / ticks;
  return cost;
}

/// Of a body of the scene; contacts and loads come on top. Zero for walls, which neither move nor are copied.
BodyCost cost_of(const sim::Model& model, const std::string& body) {
  const auto unloaded = [](const auto& m, auto& s, auto& w) { advance(m, {}, {}, s, w); };
  return sim::visit(
      model, sim::body_of(model, body), BodyCost{},
      sim::Overloaded{[&](sim::SolidRef r) { return cost_of(model_of(model, r).network, unloaded); },
                      [&](sim::CuttableRef r) { return cost_of(model_of(model, r).body, unloaded); },
                      [&](sim::StrandRef r) {
                        return cost_of(model.strand_bodies[r.index].model,
                                       [](const auto& m, auto& s, auto& w) { advance(m, {}, {}, {}, {}, s, w); });
                      },
                      [&](sim::MembraneRef r) {
                        return cost_of(model_of(model, r).sheet,
                                       [](const auto& m, auto& s, auto& w) { advance(m, {}, {}, {}, s, w); });
                      }});
}

Json describe(const sim::MotionModel& motion, const sim::Model& model) {
  Json out = Json::object();
  for (const sim::PeristalsisModel& p : motion.peristalsis)
    out["peristalsis"].push_back({{"solid", model.solids[std::size_t(p.solid)].name},
                                  {"per_minute", 60 / p.wave.period},
                                  {"pairs", p.wave.pairs.size()}});
  if (motion.breathing.there())
    out["breathing"] = {{"per_minute", 60 / motion.breathing.period},
                        {"amplitude_mm", 1e3 * length(motion.breathing.way)}};
  return out;
}

Json describe(const scene::BodyReport& b, const sim::Model& model, const scene::EquilibriumCheck& equilibrium) {
  Json out = describe(b);
  if (const BodyCost cost = cost_of(model, b.name); cost.bytes > 0) {
    out["memory_kb"] = cost.bytes / 1024;
    out["tick_us"] = cost.seconds * 1e6;
  }
  if (const int m = model.membrane_index(b.name); m >= 0 && b.kind == "pouch") {
    const tissue::EnclosureState& inside = equilibrium.state.membranes[std::size_t(m)].enclosure;
    out["at_rest"] = {{"volume_ml", inside.volume * 1e6}, {"pressure_Pa", inside.pressure}};
  }
  if (const int organ = model.organ_index(b.name); organ >= 0)
    out["off_at_rest_mm"] = 1e3 * equilibrium.organs[std::size_t(organ)].off;
  return out;
}

void print_motion(const Json& motion) {
  if (motion.contains("peristalsis"))
    for (const Json& p : motion["peristalsis"])
      fmt::print("{}", tr("  {}: {:g} waves a minute, {} pairs of points of its wall\n", p["solid"].get<std::string>(),
                          p["per_minute"].get<double>(), p["pairs"].get<std::size_t>()));
  if (motion.contains("breathing"))
    fmt::print("{}", tr("  {:g} breaths a minute of {:g} mm\n", motion["breathing"]["per_minute"].get<double>(),
                        motion["breathing"]["amplitude_mm"].get<double>()));
}

}  // namespace

Json describe_scene(const fs::path& path, const std::vector<std::string>& only,
                    const std::function<void(const sim::Model&)>& fits) {
  ProgressNotice told(path.string());
  told.at("compiling");
  scene::CompileReport report;
  report.said = [&told](const std::string& organ, double share) {
    told.at(tr("computing the static solver of '{}', {:.0f} %", organ, 100 * share));
  };
  const std::size_t before = bytes_in_use();
  const sim::Model model = scene::compile(scene::read_scene(path), &report);
  const std::size_t with_model = bytes_in_use();
  if (fits) fits(model);
  sim::State state = sim::initial_state(model);
  const std::size_t with_state = bytes_in_use();
  sim::Work work = sim::make_work(model);
  const std::size_t with_work = bytes_in_use();
  told.at(tr("timing a tick"));
  const double tick = resting_tick(model, state, work);
  told.at(tr("checking its equilibrium"));
  const scene::EquilibriumCheck equilibrium = scene::check_equilibrium(model, kStandTicks);
  Json out{{"scene", path.string()},
           {"model_hash", core::hex(model.hash)},
           {"free_nodes", model.free_nodes()},
           {"memory_kb",
            {{"model", (with_model - before) / 1024},
             {"state", (with_state - with_model) / 1024},
             {"work", (with_work - with_state) / 1024}}},
           {"tick_at_rest_us", tick * 1e6},
           {"stood_s", equilibrium.seconds},
           {"doubts", Json::array()},
           {"sinks", Json::array()},
           {"bodies", Json::array()}};
  if (model.motion.there() && only.empty()) out["motion"] = describe(model.motion, model);
  for (const core::Fault& warning : report.warnings) out["doubts"].push_back(core::to_string(warning));
  const auto listed = [&only](const std::string& name) {
    return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
  };
  for (const scene::EquilibriumCheck::Organ& o : equilibrium.organs)
    if (o.is_unstable() && listed(o.name)) out["sinks"].push_back(scene::in_words(equilibrium, o));
  told.at("timing its bodies");
  for (const scene::BodyReport& b : report.bodies)
    if (listed(b.name)) out["bodies"].push_back(describe(b, model, equilibrium));
  out["verdict"] = verdict_of(out);
  return out;
}

bool lists_file(const fs::path& file, const char* list, const fs::path& wanted) {
  std::vector<core::Fault> faults;
  const scene::JsonDocument document = scene::load_json(file, faults);
  const scene::JsonMember* names = document.root.find(list);
  if (!names) return false;
  std::error_code error;
  return std::any_of(names->value.items.begin(), names->value.items.end(), [&](const scene::JsonValue& item) {
    return item.kind == scene::JsonValue::Kind::string && fs::equivalent(file.parent_path() / item.text, wanted, error);
  });
}

std::string verdict_of(const Json& scene) {
  if (!scene["sinks"].empty()) return kSinks;
  return scene["doubts"].empty() ? "good" : "to mend";
}

void print_scene(const Json& r) {
  fmt::print("  {:31} {:8} {:>6} {:>7} {:>9} {:>13} {:>6} {:>18} {:>8} {:>8} {:>6}\n", "body", "kind", "nodes",
             "springs", "sub-steps", "dt limit [ms]", "margin", "(4b): one k, all k", "mass [g]", "mem [kB]", "us");
  for (const Json& b : r["bodies"]) {
    const auto number = [&b](const char* key, const char* format) {
      return b.contains(key) ? fmt::format(fmt::runtime(format), b[key].get<double>()) : std::string("-");
    };
    const std::string printed =
        b.contains("dt_limit_as_printed_ms")
            ? number("dt_limit_as_printed_ms", "{:.3f}") + ", " + number("dt_limit_as_printed_summed_ms", "{:.3f}")
            : "-";
    fmt::print("  {:31} {:8} {:>6} {:>7} {:>9} {:>13} {:>6} {:>18} {:>8} {:>8} {:>6}\n", b["name"].get<std::string>(),
               b["kind"].get<std::string>(), number("nodes", "{:.0f}"),
               number(b.contains("springs") ? "springs" : "triangles", "{:.0f}"), number("substeps", "{:.0f}"),
               number("dt_limit_ms", "{:.4f}"), number("dt_margin", "{:.2f}"), printed, number("mass_g", "{:.1f}"),
               number("memory_kb", "{:.0f}"), number("tick_us", "{:.1f}"));
  }
  for (const Json& b : r["bodies"])
    if (b.contains("at_rest"))
      fmt::print("  {}\n", tr("{} contains {:.1f} mL at {:.0f} Pa; after {:.2g} s at rest {:.1f} mL at {:.0f} Pa",
                              b["name"].get<std::string>(), b.value("volume_ml", 0.0), b.value("pressure_Pa", 0.0),
                              r["stood_s"].get<double>(), b["at_rest"]["volume_ml"].get<double>(),
                              b["at_rest"]["pressure_Pa"].get<double>()));
  for (const char* list : {"doubts", "sinks"})
    if (r.contains(list))
      for (const Json& text : r[list]) fmt::print("  {}\n", text.get<std::string>());
  if (r.contains("motion")) print_motion(r["motion"]);
  fmt::print("  {}\n", tr("(4b): the paper's limit, with a node's stiffest spring and with all of its springs"));
  const Json& m = r["memory_kb"];
  fmt::print("  {}\n", tr("{} free nodes; memory {} kB model, {} kB state, {} kB work", r["free_nodes"].get<int>(),
                          m["model"].get<std::size_t>(), m["state"].get<std::size_t>(), m["work"].get<std::size_t>()));
  fmt::print("  {}\n", tr("Load at rest, measured now on this machine, no part of the verdict: {:.0f} % of real time",
                          0.1 * r["tick_at_rest_us"].get<double>()));
  const double tick = 1e-6 * r["tick_at_rest_us"].get<double>();
  if (tick > sim::kTick)
    fmt::print("  {}\n", tr("Here and now it would run in slow motion: {:.2g} of real time", sim::kTick / tick));
  if (r["stood_s"].get<double>() < double(kStandTicks) * sim::kTick)
    fmt::print("  {}\n",
               tr("Equilibrium was checked for {:.2g} s only, as the scene is heavy", r["stood_s"].get<double>()));
}

}  // namespace trocar::app
