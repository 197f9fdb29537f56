// trocar report: the result that a recording ends with, as JSON or as an HTML page.
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/sim/recording.hpp>

#include "command.hpp"
#include "json.hpp"
#include "report_page.hpp"

namespace trocar::app {
namespace {

Json parsed(const std::string& text) {
  Json value = Json::parse(text, nullptr, false);
  return value.is_object() ? value : Json::object();
}

/// What the file says of itself; the result is that of the attempt's end, or how far an interrupted one came.
Json summary(const sim::Recording& r, const std::string& file) {
  Json out{{"recording", file},
           {"exercise", r.header.exercise},
           {"program_version", r.header.program_version},
           {"model_hash", hex(r.header.model_hash)},
           {"ticks", r.inputs.size()},
           {"complete", r.complete}};
  if (!r.damage.empty()) out["damage"] = r.damage;
  out.update(parsed(r.header.metadata_json));
  out.update(parsed(r.result_json));
  return out;
}

int report(const std::string& file, const std::string& folder, bool json) {
  const sim::Recording recording = sim::read_recording(file);
  Json result = summary(recording, file);
  if (!recording.complete) core::log::warn("{}: the attempt was interrupted or the file is damaged", file);
  if (!folder.empty()) result["report"] = write_report(folder, result);
  if (json || folder.empty())
    print(result);
  else
    fmt::print("{}\n", result["report"].get<std::string>());
  return core::kDone;
}

}  // namespace

void add_report(CLI::App& program, Chosen& chosen) {
  struct Options {
    std::string file, out;
  };
  auto o = std::make_shared<Options>();
  CLI::App* c =
      add_command(program, chosen, "report", "Show the result of a recording", "trocar report a.rec --out report");
  c->add_option("recording", o->file, "a recording (train --record)")->required();
  c->add_option("--out", o->out, "write an HTML page to this folder; without it the result is printed as JSON");
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return report(o->file, o->out, chosen.json); }; });
}

}  // namespace trocar::app
