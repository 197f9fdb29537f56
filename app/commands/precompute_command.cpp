// trocar precompute: makes the static solvers of a scene's organs, so that they are there when somebody trains.

#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/solver_beside.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"
#include "commands/progress_notice.hpp"

namespace trocar::app {
namespace {

struct PrecomputeChoice {
  std::string exercise;
  std::vector<std::string> organs;  ///< that count as static, whatever their files say
  std::uint64_t seed = 0;
};

Json described(const scene::ComplianceReport& r) {
  return {{"organ", r.organ},
          {"nodes", r.nodes},
          {"kept", r.kept},
          {"megabytes", 1e-6 * r.bytes},
          {"seconds", r.seconds},
          {"computed", r.computed},
          {"file", r.file},
          {"note", r.note},
          {"megabytes_while_made", 1e-6 * r.most_bytes}};
}

void print_solvers(const Json& result) {
  fmt::print("{:20} {:>7} {:>7} {:>8} {:>8}  {:9}  {}\n", "organ", "nodes", "kept", "MB", "s", "", "file");
  for (const Json& r : result["organs"]) {
    const std::string file = r["file"].get<std::string>();
    fmt::print("{:20} {:>7} {:>7} {:>8.1f} {:>8.2f}  {:9}  {}\n", r["organ"].get<std::string>(), r["nodes"].get<int>(),
               r["kept"].get<int>(), r["megabytes"].get<double>(), r["seconds"].get<double>(),
               r["computed"].get<bool>() ? "computed" : "was there",
               file.empty() ? r["note"].get<std::string>() : file);
  }
}

void print_none(const std::string& scene, const Json& names) {
  std::string all;
  for (const Json& name : names) all += (all.empty() ? "" : ", ") + name.get<std::string>();
  fmt::print("{}",
             tr("{}: no organ has a static solver. Write \"solver\": \"static\" at a solid in an organ's file, or name "
                "organs with --organ: {}\n",
                scene, all.empty() ? "there are none" : all));
}

int precompute(const PrecomputeChoice& o, bool json) {
  ProgressNotice told(o.exercise);
  told.at("compiling");
  scene::CompileReport report;
  report.said = [&told](const std::string& organ, double share) {
    told.at(tr("making the static solver of '{}', {:.0f} %", organ, 100 * share));
  };
  std::vector<std::string> names;
  const auto adapt = [&](scene::Description& scene) {
    for (const std::string& organ : o.organs) attempt::set_solver(scene, organ, scene::Solver::elastostatic);
    names = attempt::organ_names(scene);
  };
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_adapted(o.exercise, o.seed, adapt, &report);
  Json result{{"scene", lesson->scene.string()}, {"seed", o.seed}, {"organs", Json::array()}, {"known", names}};
  for (const scene::ComplianceReport& r : report.compliances) result["organs"].push_back(described(r));
  if (json)
    print(result);
  else if (result["organs"].empty())
    print_none(result["scene"].get<std::string>(), result["known"]);
  else
    print_solvers(result);
  return core::kDone;
}

}  // namespace

void add_precompute(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<PrecomputeChoice>();
  CLI::App* c = add_command(program, chosen, "precompute", tr("Compute the static solvers of a scene's organs"),
                            "trocar precompute gynaecology --organ bladder");
  c->add_option("exercise", o->exercise, tr("a scene or an exercise: a name that `trocar list` shows, or a file"))
      ->required();
  c->add_option("--organ", o->organs, tr("an organ that gets a static solver whatever its file says; repeatable"));
  c->add_option("--seed", o->seed, tr("number of a random patient; 0: the standard patient"))
      ->capture_default_str()
      ->transform(whole_number(0, kLargestSeed));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return precompute(*o, chosen.json); }; });
}

}  // namespace trocar::app
