// trocar model: the organ modeller; with --script its steps without a window.
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/script/session.hpp>

#include "commands/command.hpp"
#include "modeller/modeller.hpp"

namespace trocar::app {
namespace {

struct ModelChoice {
  std::string file, script, shots, log;
  bool list = false;
};

Json described(const scene::Shape& shape) {
  Json keys = Json::array();
  for (const scene::Key& key : shape.keys)
    keys.push_back({{"name", key.name}, {"needed", key.required}, {"meaning", key.meaning}});
  return {{"name", shape.name}, {"meaning", shape.meaning}, {"keys", keys}};
}

int list_steps(bool json) {
  Json steps = Json::array();
  for (const modeller::Operation& o : modeller::operations()) steps.push_back(described(o.parameters));
  for (const modeller::Command& c : modeller::commands()) steps.push_back(described(c.parameters));
  if (json) {
    print({{"steps", steps}});
    return core::kDone;
  }
  for (const Json& step : steps) {
    fmt::print("{}  {}\n", step["name"].get<std::string>(), step["meaning"].get<std::string>());
    for (const Json& key : step["keys"])
      fmt::print("    {:14} {}{}\n", key["name"].get<std::string>(), key["needed"].get<bool>() ? "(needed) " : "",
                 key["meaning"].get<std::string>());
  }
  return core::kDone;
}

int model(const ModelChoice& o, bool json) {
  if (o.list) return list_steps(json);
  if (o.script.empty()) {
    run_modeller({o.file, o.log});
    return core::kDone;
  }
  modeller::Session session({o.shots});
  if (!o.file.empty()) session.put(modeller::Document::open(o.file));
  const modeller::ScriptResult done = modeller::run_script(o.script, session);
  if (json)
    print({{"script", o.script},
           {"steps", done.steps},
           {"operations", done.operations},
           {"said", session.said()},
           {"pictures", session.pictures()}});
  else
    fmt::print("{}", session.draws() ? tr("{} steps, {} of them changes of the document; {} pictures in {}\n",
                                          done.steps, done.operations, session.pictures().size(), o.shots)
                                     : tr("{} steps, {} of them changes of the document; {} pictures\n", done.steps,
                                          done.operations, session.pictures().size()));
  return core::kDone;
}

}  // namespace

void add_model(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<ModelChoice>();
  CLI::App* c = add_command(program, chosen, "model", tr("Model organs and scenes, in a window or by a script"),
                            "trocar model my_organ.json\n"
                            "  trocar model --script docs/tutorials/uterus.json --shots pictures");
  c->add_option("file", o->file, tr("a scene or an organ to open"));
  c->add_option("--script", o->script, tr("a file of steps to do without a window"));
  c->add_option("--shots", o->shots, tr("folder for the script's pictures"));
  c->add_option("--log", o->log, tr("write events of the window as JSON lines to this file"));
  c->add_flag("--steps", o->list, tr("list the steps that a script can have"));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return model(*o, chosen.json); }; });
}

}  // namespace trocar::app
