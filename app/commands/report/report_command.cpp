// trocar report: what is known of an attempt as a page; all attempts as a list or a table; forgetting a trainee.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/reports/export.hpp>
#include <trocar/reports/report.hpp>
#include <trocar/reports/report_page.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/training/store/store.hpp>

#include "commands/command.hpp"
#include "commands/report/report_forget.hpp"
#include "commands/report/report_trace.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;
using training::Attempt;
using training::Store;

struct Options {
  std::string what, out, csv, trace, traces, trainee, compare;
  bool list = false, names = false, no_pictures = false;
  ForgetChoice forget;
};

/// How much of `text` fits into so many columns.
std::string cut_to(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t at = most - 1;
  while (at > 0 && (static_cast<unsigned char>(text[at]) & 0xc0) == 0x80) --at;  // not within a character
  return text.substr(0, at) + "~";
}

int list(const Store& store, const Options& o, bool json) {
  const std::vector<Attempt> attempts = store.list({.trainee = o.trainee});
  if (json) {
    Json entries = reports::attempts_json(attempts, true);
    for (Json& e : entries) e.erase("result");
    print({{"store", store.folder().string()}, {"attempts", entries}, {"notices", store.notices()}});
    return core::kDone;
  }
  if (attempts.empty()) {
    fmt::print("{}\n", o.trainee.empty() ? tr("no attempts yet in {}", store.folder().string())
                                         : no_attempts_of(store, o.trainee));
    return core::kDone;
  }
  fmt::print("{:>5}  {:16}  {:16}  {:28}  {:14}  {:12}  {:>5}  {:>8}\n", "", tr("started (UTC)"), tr("trainee"),
             tr("exercise"), tr("mode"), tr("state"), tr("score"), tr("seconds"));
  bool all_verified = true;
  for (const Attempt& a : attempts) {
    std::string begun = core::printable(a.started.substr(0, std::min<std::size_t>(16, a.started.size())));
    std::replace(begun.begin(), begun.end(), 'T', ' ');
    const bool marked = a.score && is_unverified(a);
    all_verified = all_verified && !marked;
    fmt::print("{:>5}  {:16}  {:16}  {:28}  {:14}  {:12}  {:>5}  {:8.1f}\n", a.number, begun,
               cut_to(core::printable(a.trainee), 16), cut_to(core::printable(a.exercise), 28), name_of(a.mode),
               name_of(a.state), a.score ? fmt::format("{:.0f}{}", *a.score, marked ? "*" : "") : "", a.seconds);
  }
  if (!all_verified)
    fmt::print("{}\n",
               tr("* imported from a recording and not verified: trocar replay RECORDING --verify judges again"));
  return core::kDone;
}

/// From a file: what it says itself, and what the store knows of the same attempt.
Attempt from_recording(const Store& store, const std::string& file) {
  Attempt there;
  if (!fill_from_recording(file, there)) {
    sim::read_recording(file);  // says what is wrong with it
    throw core::BadInput({{{file, 0, 0}, tr("expected a recording")}});
  }
  std::optional<Attempt> kept;
  try {
    kept = store.find(there.uuid);
  } catch (const core::EnvironmentLacks& lacks) {
    core::log::warn("{}", lacks.what());
  }
  if (!kept || kept->uuid != there.uuid) {  // another one's, whose uuid begins alike
    mark_unverified(there);
    return there;
  }
  kept->recording = there.recording;
  return *kept;
}

Attempt chosen(const Store& store, const Options& o) {
  std::error_code error;
  if (!o.what.empty() && fs::is_regular_file(o.what, error)) return from_recording(store, o.what);
  if (!o.what.empty()) {
    if (std::optional<Attempt> a = store.find(o.what)) return *a;
    throw core::BadInput(
        {{{o.what, 0, 0},
          tr("expected a recording, or an attempt's number or uuid as `trocar report --list` shows them")}});
  }
  const std::vector<Attempt> all = store.list({.trainee = o.trainee, .limit = 1});
  if (all.empty())
    throw core::BadInput(
        {{{"report", 0, 0},
          o.trainee.empty() ? tr("expected an attempt, there is none yet: make one with `trocar train`")
                            : no_attempts_of(store, o.trainee)}});
  return store.find(all.back().uuid).value_or(all.back());  // deleted meanwhile: without its motion
}

Json summary(const reports::Report& r) {
  Json out = reports::attempts_json({r.attempt}, r.names)[0];
  const Json result = out["result"];
  out.erase("result");
  if (!r.names) out.erase("trainee");
  out.update(result);
  out["complete"] = r.attempt.state == training::AttemptState::finished;
  return out;
}

int report(Store& store, const Options& o, bool json) {
  Attempt attempt = chosen(store, o);
  if (!o.compare.empty()) {
    if (o.compare != "demo") throw core::BadInput({{{"--compare", 0, 0}, tr("expected demo, got '{}'", o.compare)}});
    if (!reports::gather(&store, attempt).scripted) reports::demonstrate(store, attempt.exercise, attempt.seed);
  }
  reports::Report r = reports::gather(&store, std::move(attempt));
  r.names = o.names;
  if (training::is_unverified(r.attempt))
    core::log::warn("{}",
                    tr("this result is as its recording has it and is not verified: trocar replay RECORDING --verify "
                       "judges again"));
  if (r.attempt.state != training::AttemptState::finished)
    core::log::warn("attempt {}: {}", r.attempt.uuid, name_of(r.attempt.state));
  Json result = summary(r);
  if (!o.csv.empty()) write_text(o.csv, reports::attempts_csv({r.attempt}, o.names));
  if (!o.trace.empty()) {
    if (!r.trace && r.attempt.recording.empty())
      throw core::BadInput(
          {{{"--trace", 0, 0}, tr("expected an attempt with its motion or a recording, got neither")}});
    if (!r.trace) r.trace = trace_of_recording(r.attempt.recording);
    write_text(o.trace, to_csv(*r.trace, origin_of(r.attempt, o.names)));
  }
  const bool page = !o.out.empty() || (!json && o.csv.empty() && o.trace.empty());
  if (page) {
    const fs::path folder = o.out.empty() ? page_folder(store, r.attempt) : fs::path(o.out);
    attempt::make_folder(folder);
    if (!o.no_pictures && !r.attempt.recording.empty()) reports::add_pictures(r, r.attempt.recording, folder);
    result["report"] = reports::write_report(folder, r);
  }
  if (json)
    print(result);
  else if (page)
    fmt::print("{}\n", result["report"].get<std::string>());
  return core::kDone;
}

int run(const Options& o, bool json) {
  Store store(attempt::data_folder());
  if (!o.forget.trainee.empty())
    return forget_trainee(store, {training::clean_name(o.forget.trainee), o.forget.dry_run, o.forget.yes}, json);
  if (o.forget.dry_run || o.forget.yes)
    throw core::BadInput(
        {{{o.forget.yes ? "--yes" : "--dry-run", 0, 0}, tr("expected --forget NAME with it, got none")}});
  if (o.list) return list(store, o, json);
  if (!o.csv.empty() && o.what.empty()) {
    const std::vector<Attempt> all = store.list({.trainee = o.trainee});
    write_text(o.csv, reports::attempts_csv(all, o.names));
    if (json) print({{"csv", o.csv}, {"attempts", reports::attempts_json(all, o.names)}});
    return core::kDone;
  }
  if (!o.traces.empty()) {
    const int written = write_traces(store, o.trainee, o.names, o.traces);
    if (json) print({{"traces", o.traces}, {"written", written}});
    if (written == 0) core::log::warn("{}", tr("no attempt with its motion was found"));
    return written > 0 ? core::kDone : core::kGoalNotReached;
  }
  return report(store, o, json);
}

}  // namespace

void add_report(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<Options>();
  CLI::App* c = add_command(program, chosen, "report", tr("Show how an attempt went; list, export and delete attempts"),
                            "trocar report\n"
                            "  trocar report --list\n"
                            "  trocar report 12 --out report --compare demo\n"
                            "  trocar report attempt.rec --trace motion.csv\n"
                            "  trocar report --csv attempts.csv --names\n"
                            "  trocar report --traces motions && trocar trials motions\n"
                            "  trocar report --forget Ada --dry-run");
  const char* page = tr("Page of one attempt");
  const char* tables = tr("Lists and tables");
  const char* deletion = tr("Deletion");
  c->add_option("attempt", o->what, tr("number or uuid from --list, or a recording; default: the latest attempt"));
  c->add_option("--out", o->out, tr("folder of the page; default: reports/UUID in the data folder"))->group(page);
  c->add_option("--compare", o->compare,
                tr("demo: compare with the demonstration, which is computed now where it is missing"))
      ->group(page);
  c->add_flag("--no-pictures", o->no_pictures, tr("no pictures of key moments: faster"))->group(page);
  c->add_flag("--list", o->list, tr("list all attempts, oldest first"))->group(tables);
  c->add_option("--trainee", o->trainee, tr("only attempts of this trainee"))->group(tables);
  c->add_option("--csv", o->csv, tr("write the attempt, or without one all attempts, as a table to this file"))
      ->group(tables);
  c->add_option("--trace", o->trace, tr("write the attempt's motion, 50 samples a second, as a table to this file"))
      ->group(tables);
  c->add_option("--traces", o->traces, tr("write the motion of all attempts, a file each, to this folder"))
      ->group(tables);
  c->add_flag("--names", o->names, tr("include the trainee's name in page and tables"));
  c->add_option("--forget", o->forget.trainee, tr("delete this trainee's attempts, recordings and reports; asks first"))
      ->group(deletion);
  c->add_flag("--yes", o->forget.yes, tr("--forget: do not ask"))->group(deletion);
  c->add_flag("--dry-run", o->forget.dry_run, tr("--forget: only list what would be deleted"))->group(deletion);
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return run(*o, chosen.json); }; });
}

}  // namespace trocar::app
