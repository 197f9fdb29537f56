#include "commands/mechanisms/design_studies.hpp"

#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/reports/design_page.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/json/shape.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/studies/clearance.hpp>
#include <trocar/studies/optimise.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"

namespace trocar::app {

using namespace studies;
using kinematics::Measure;
using kinematics::Mechanism;
using kinematics::Parameter;

namespace {

constexpr std::size_t kShownEffects = 12;

/// Leaves the page where one was asked for. @return its path, or ""
std::string leave_page(const DesignOptions& o, const std::string& html) {
  if (o.report.empty()) return {};
  attempt::make_folder(o.report);
  return reports::write_design_page(o.report, html);
}
void tell_page(const std::string& page) {
  if (!page.empty()) fmt::print("  page: {}\n", page);
}

void print_tolerance(const Json& r) {
  const std::string unit = r["unit"];
  const Json& linear = r["linear"];
  fmt::print("{}: {}, nominal {:.6f} {}\n", r["name"].get<std::string>(), r["measured"].get<std::string>(),
             r["nominal"].get<double>(), r["nominal_unit"].get<std::string>());
  fmt::print("{}",
             tr("  first order: worst {:.4f}, root of squares {:.4f}, standard deviation {:.4f} {}\n",
                linear["worst"].get<double>(), linear["rss"].get<double>(), linear["deviation"].get<double>(), unit));
  fmt::print("{}", tr("  Monte Carlo: mean {:+.4f}, standard deviation {:.4f}, from {:.4f} to {:.4f} {}\n",
                      r["mean"].get<double>(), r["deviation"].get<double>(), r["low"].get<double>(),
                      r["high"].get<double>(), unit));
  for (const Json& p : r["percentiles"])
    fmt::print("    {:>7} %: {:+.4f}\n", p["percent"].get<double>(), p["deviation"].get<double>());
  fmt::print("{}",
             tr("  {} samples, {} did not close\n", r["samples"].get<std::int64_t>(), r["open"].get<std::int64_t>()));
  if (!r["within"].is_null())
    fmt::print("{}", tr("  yield: {:.4f} % within {:.4g} {}\n", 100 * r["yield"].get<double>(),
                        r["within"].get<double>(), unit));
  fmt::print("  {:36} {:>12} {:>14} {:>9}\n", "dimension", "plus-minus", "effect " + unit, "variance");
  std::size_t shown = 0;
  for (const Json& s : r["sensitivities"]) {
    if (shown++ == kShownEffects) break;
    fmt::print("  {:36} {:>8.4g} {:3} {:>14.4f} {:>7.2f} %\n", s["name"].get<std::string>(),
               s["plus_minus"].get<double>(), s["unit"].get<std::string>(), s["effect"].get<double>(),
               100 * s["share"].get<double>());
  }
  if (r["sensitivities"].size() > kShownEffects)
    fmt::print("{}", tr("  and {} with less\n", r["sensitivities"].size() - kShownEffects));
  if (!r["misfits"].empty())
    fmt::print("{}", tr("  {} dimensions are left out: changed alone, they would open a loop\n", r["misfits"].size()));
}

/// A pose that no study can be about: told, not thrown.
int tell_no_pose(const Mechanism& m, const char* kind, const std::string& words, bool json) {
  fmt::print(stderr, "{}: {}\n", m.name, words);
  if (json) print({{"name", m.name}, {"kind", kind}, {"closed", false}, {"words", words}});
  return core::kGoalNotReached;
}

ClearanceOptions sweep_of(const Mechanism& m, const DesignOptions& o) {
  ClearanceOptions out;
  out.steps = o.steps;
  out.samples = o.poses;
  out.strict = o.strict;
  const auto link = [&](const std::string& name) {
    const int index = m.link(name);
    if (index < 0) refuse_words(name, scene::unknown_name("link", name, m.links));
    return index;
  };
  for (const std::string& word : o.ignored) {
    const std::size_t at = word.find(':');
    if (at == word.npos) refuse_words(word, tr("expected LINK:LINK, got \"{}\"", word));
    out.ignored.emplace_back(link(word.substr(0, at)), link(word.substr(at + 1)));
  }
  return out;
}

Json pair_json(const Mechanism& m, const ClearanceReport& r, const PairClearance& p) {
  Json where = Json::object();
  for (std::size_t d = 0; d < p.handles.size(); ++d) where[r.drives[d]] = p.handles[d];
  return {{"first", m.links[std::size_t(p.first)]},
          {"second", m.links[std::size_t(p.second)]},
          {"least_mm", 1e3 * p.least},
          {"most_mm", 1e3 * p.most},
          {"beside_joint", p.beside_joint},
          {"where", where}};
}
Json clearance_json(const Mechanism& m, const ClearanceReport& r) {
  Json pairs = Json::array(), joined = Json::array();
  for (const PairClearance& p : r.pairs) pairs.push_back(pair_json(m, r, p));
  for (const PairClearance& p : r.joined) joined.push_back(pair_json(m, r, p));
  return {{"poses", r.poses},     {"freedoms", r.drives.size()},
          {"reached", r.reached}, {"least_mm", r.pairs.empty() ? Json(nullptr) : Json(1e3 * r.least)},
          {"pairs", pairs},       {"always_overlapping", joined}};
}
void print_clearance(const Json& r) {
  fmt::print("{}",
             r["freedoms"].get<int>() > 1
                 ? tr("  {} poses of {} freedoms tried (Halton's sequence), {} closed and within limits\n",
                      r["poses"].get<int>(), r["freedoms"].get<int>(), r["reached"].get<int>())
                 : tr("  {} poses, {} closed and within limits\n", r["poses"].get<int>(), r["reached"].get<int>()));
  if (r["pairs"].empty()) fmt::print("{}", tr("  no links that could meet\n"));
  for (const Json& p : r["pairs"]) {
    std::string where;
    for (const auto& [name, handle] : p["where"].items())
      where += fmt::format(" {}={:.4f}", name, handle.get<double>());
    fmt::print("  {:20} {:20} {:>10.4f} mm {} at{}\n", p["first"].get<std::string>(), p["second"].get<std::string>(),
               p["least_mm"].get<double>(), p["least_mm"].get<double>() < 0 ? tr("IN EACH OTHER") : tr("apart"), where);
    if (p["beside_joint"].get<bool>())
      fmt::print("{}", tr("    they share a joint, and are deeper in each other than drawn, beside it\n"));
  }
  for (const Json& p : r["always_overlapping"])
    fmt::print("{}", tr("  {} and {} overlap in every pose: taken as meant\n", p["first"].get<std::string>(),
                        p["second"].get<std::string>()));
}

double shown_value(const Parameter& p, double value) {
  return p.measure == Measure::angle ? value * 180 / portable::pi : p.measure == Measure::length ? 1e3 * value : value;
}
const char* file_unit(const Parameter& p) {
  return p.measure == Measure::angle ? "deg" : p.measure == Measure::length ? "mm" : "";
}

/// @return where it was written to
std::string write_optimised(const DesignOptions& o, const std::vector<double>& values) {
  if (o.path.extension() != ".json")
    throw core::BadInput({{{"--output", 0, 0}, tr("expected a mechanism in JSON, got {}", o.path.generic_string())}});
  const std::string text = scene::mechanism_text_with(core::read_file(o.path, scene::kMaxJsonBytes), values);
  if (const std::string fault = core::write_file(o.output, text.data(), text.size()); !fault.empty())
    throw core::EnvironmentLacks(tr("{} cannot be written: {}", o.output, fault));
  return o.output;
}

}  // namespace

void add_design_options(CLI::App& c, DesignOptions& o) {
  add_study_options(c, o.study);
  const char* clearance = tr("Clearance and optimisation");
  c.add_option("--ignore", o.ignored, tr("a pair of links that may touch, as LINK:LINK; repeatable"))->group(clearance);
  c.add_flag("--strict", o.strict, tr("count pairs too that overlap in every pose"))->group(clearance);
  c.add_option("--steps", o.steps, tr("clearance: poses along the path of a single drive"))
      ->transform(whole_number(2, 100'000))
      ->capture_default_str()
      ->group(clearance);
  c.add_option("--poses", o.poses, tr("clearance: poses within limits where there are several drives"))
      ->transform(whole_number(1, 1'000'000))
      ->capture_default_str()
      ->group(clearance);
  c.add_option("--clearance-um", o.clearance_um, tr("optimise: least distance of links [um]"))
      ->check(number_between(0, 1e5, "um"))
      ->capture_default_str()
      ->group(clearance);
  c.add_option("--keep", o.keep, tr("optimise: least share of the range of --frame that remains"))
      ->check(number_between(0, 1, ""))
      ->capture_default_str()
      ->group(clearance);
  c.add_option("--output", o.output, tr("optimise: write the mechanism with its new dimensions to this file"))
      ->group(clearance);
  c.add_option("--report", o.report, tr("tolerance, clearance, optimise: folder for a page with drawings"));
}

int show_tolerance(const Mechanism& m, const DesignOptions& o, bool json) {
  StudyTask task;
  try {
    task = prepare(m, o.study);
  } catch (const std::invalid_argument& e) {
    return tell_no_pose(m, "tolerance", e.what(), json);
  }
  std::vector<double> values(std::size_t(o.study.samples));
  core::ThreadPool pool(o.study.threads > 0 ? o.study.threads : core::default_thread_count());
  const auto began = std::chrono::steady_clock::now();
  task.study->sample(std::uint64_t(o.study.seed), 0, values, &pool);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  const Statistics s = statistics(values, task.study->linear().nominal, task.limits, o.study.bins);
  const std::string page = leave_page(
      o, o.report.empty()
             ? std::string()
             : reports::tolerance_html(*task.study, s, {task.words, task.unit.name, task.unit.by, task.limits}));
  Json out = study_json(task, values, s);
  out["seconds"] = seconds;
  out["threads"] = pool.threads();
  if (!page.empty()) out["page"] = page;
  if (json) {
    print(out);
  } else {
    print_tolerance(out);
    tell_page(page);
  }
  return core::kDone;
}

int show_clearance(const Mechanism& m, const DesignOptions& o, bool json) {
  ClearanceReport r;
  try {
    r = clearance_over_motion(m, sweep_of(m, o));
  } catch (const std::invalid_argument& e) {
    return tell_no_pose(m, "clearance", e.what(), json);
  }
  const std::string page = leave_page(o, o.report.empty() ? std::string() : reports::clearance_html(m, r));
  Json out = clearance_json(m, r);
  out.update({{"name", m.name}, {"kind", "clearance"}});
  if (!page.empty()) out["page"] = page;
  if (json) {
    print(out);
  } else {
    fmt::print("{}", tr("{}: clearance between its links\n", m.name));
    print_clearance(out);
    tell_page(page);
  }
  return r.reached > 0 && !(r.least < 0) ? core::kDone : core::kGoalNotReached;
}

int show_optimised(const Mechanism& m, const DesignOptions& o, bool json) {
  OptimiseOptions wish;
  wish.clearance = 1e-6 * o.clearance_um;
  wish.keep = o.keep;
  if (!o.study.frame.empty()) wish.follow = frame_named(m, o.study.frame);
  OptimiseResult r;
  try {
    r = optimise(m, wish, sweep_of(m, o));
  } catch (const std::invalid_argument& e) {
    return tell_no_pose(m, "optimise", e.what(), json);
  }
  const std::string page =
      leave_page(o, o.report.empty() ? std::string() : reports::optimise_html(m, r, wish.clearance));
  Json dimensions = Json::array();
  for (const int i : r.parameters) {
    const Parameter& p = m.parameters[std::size_t(i)];
    dimensions.push_back({{"name", p.name},
                          {"unit", file_unit(p)},
                          {"before", shown_value(p, m.parameter_values[std::size_t(i)])},
                          {"after", shown_value(p, r.values[std::size_t(i)])}});
  }
  Json out{{"name", m.name},
           {"kind", "optimise"},
           {"free", r.free},
           {"dimensions", dimensions},
           {"before", clearance_json(m, r.before)},
           {"after", clearance_json(m, r.after)},
           {"range_share", r.range_before > 0 ? Json(r.range_after / r.range_before) : Json(nullptr)},
           {"end_off_mm", 1e3 * r.end_off},
           {"tried", r.evaluations},
           {"starts", r.starts}};
  if (!page.empty()) out["page"] = page;
  if (!o.output.empty()) out["file"] = write_optimised(o, r.values);
  if (json) {
    print(out);
  } else {
    fmt::print("{}: {}\n", m.name,
               r.free ? "free of collisions with these dimensions" : "no dimensions found that do all that was asked");
    for (const Json& d : dimensions)
      fmt::print("  {:20} {:>10.4f} -> {:>10.4f} {}\n", d["name"].get<std::string>(), d["before"].get<double>(),
                 d["after"].get<double>(), d["unit"].get<std::string>());
    fmt::print("{}", r.range_before > 0 ? tr("  {} tried from {} starts; range of {} {:.1f} %\n", r.evaluations,
                                             r.starts, o.study.frame, 100 * r.range_after / r.range_before)
                                        : tr("  {} tried from {} starts\n", r.evaluations, r.starts));
    if (m.drives.size() == 1)
      fmt::print("{}", tr("  with {} at 1 it ends {:.4f} mm from where it did\n", m.drives[0].name, 1e3 * r.end_off));
    fmt::print(" before:\n");
    print_clearance(out["before"]);
    fmt::print(" after:\n");
    print_clearance(out["after"]);
    tell_page(page);
  }
  return r.free ? core::kDone : core::kGoalNotReached;
}

}  // namespace trocar::app
