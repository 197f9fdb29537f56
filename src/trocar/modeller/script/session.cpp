#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/modeller/drive/places.hpp>
#include <trocar/modeller/script/session.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::modeller {

Document& Session::document() {
  if (!m_document) throw core::BadInput({{{"", 0, 0}, "expected a document, got none: open or begin one first"}});
  return *m_document;
}

Scan& Session::scan() {
  if (!m_scan) throw core::BadInput({{{"", 0, 0}, "expected a scan, got none: read one first"}});
  return *m_scan;
}

void Session::keep_picture(const std::string& name, const render::Image& image) {
  std::error_code ignored;
  fs::create_directories(m_options.shots, ignored);
  const fs::path file = m_options.shots / fmt::format("{:03}-{}.png", m_pictures.size(), name);
  render::write_png(file.string(), image);
  m_pictures.push_back(file.string());
}

void Session::put(Document document) {
  m_document = std::move(document);
  m_is_built = false;
  m_drive.reset();
}

const Built& Session::built() {
  if (m_is_built && m_built.version == document().version()) return m_built;
  m_drive.reset();
  if (m_easel) m_easel->show(nullptr);
  m_shown = nullptr;
  m_built = build(document());
  m_is_built = true;
  return m_built;
}

const sim::Model& Session::model() {
  if (!built().good()) throw core::BadInput(m_built.faults);
  return *m_built.model;
}

TestDrive& Session::drive() {
  const sim::Model& of = model();
  if (!m_drive) m_drive = std::make_unique<TestDrive>(of);
  return *m_drive;
}

void Session::shot(const std::string& name, const std::string& thing, const std::string& of, double yaw, double pitch,
                   double distance, bool scope) {
  const sim::Model& shown = model();
  if (!draws()) return;
  if (!m_easel) m_easel = std::make_unique<Easel>(m_options.width, m_options.height);
  if (m_shown != &shown) m_easel->show(&shown);
  m_shown = &shown;
  const sim::State start = m_drive ? m_drive->state() : sim::initial_state(shown);
  std::vector<Vec3d> places;
  for (const BodyPlace& p : places_of(shown, start))
    if (of.empty() || sim::name_of(shown, p.body) == of) places.push_back(p.at);
  view::Orbit orbit = orbit_of(places);
  orbit.yaw = yaw;
  orbit.pitch = pitch;
  if (distance > 0) orbit.distance = distance;
  const Handles handles = thing.empty() ? Handles{} : handles_of(document(), thing);
  keep_picture(name, scope ? m_easel->through_scope(start) : m_easel->outside(start, orbit, handles));
}

void run_step(const scene::JsonValue& step, const std::string& file, Session& session) {
  const auto refuse = [&](const scene::JsonValue& at, std::string message) {
    throw core::BadInput({{{file, at.line, at.column}, std::move(message)}});
  };
  const scene::JsonMember* name = step.find("do");
  if (!name || name->value.kind != scene::JsonValue::Kind::string)
    refuse(step, "expected a step that says what it does: {\"do\": \"move\", ...}");
  scene::JsonValue parameters = step;
  parameters.members.erase(parameters.members.begin() + (name - step.members.data()));
  try {
    if (const Operation* operation = find_operation(name->value.text)) {
      const std::string said = apply(*operation, parameters, file, session.document());
      if (!said.empty()) session.said().push_back({{"do", name->value.text}, {"said", said}});
      return;
    }
    if (const Command* command = find_command(name->value.text)) {
      std::vector<core::Fault> faults;
      const scene::JsonObject o(parameters, command->parameters, file, faults);
      if (faults.empty()) command->run(o, session);
      if (!faults.empty()) throw core::BadInput(std::move(faults));
      return;
    }
  } catch (const core::BadInput& bad) {  // what has no place is told with the step's
    std::vector<core::Fault> faults = bad.faults();
    for (core::Fault& f : faults)
      if (f.at.file.empty()) f.at = {file, step.line, step.column};
    throw core::BadInput(std::move(faults));
  }
  std::vector<std::string> known;
  for (const Operation& operation : operations()) known.push_back(operation.parameters.name);
  for (const Command& command : commands()) known.push_back(command.parameters.name);
  refuse(name->value, scene::unknown_name("step", name->value.text, known));
}

ScriptResult run_script(const fs::path& script, Session& session) {
  std::vector<core::Fault> faults;
  const scene::JsonDocument document = scene::load_json(script, faults);
  static const scene::Shape shape{
      "script",
      "Steps for the modeller, one after another.",
      {scene::keys::format(1), scene::needed(scene::keys::any("steps", "an array of steps")),
       scene::keys::text("$schema", "where editors find this kind of file's schema"),
       scene::keys::text("title", "one line for people")}};
  const scene::JsonObject o(document.root, shape, document.file, faults);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  ScriptResult out;
  for (const scene::JsonValue& step : o.value().find("steps")->value.items) {
    run_step(step, document.file, session);
    ++out.steps;
    if (const scene::JsonMember* name = step.find("do")) out.operations += find_operation(name->value.text) != nullptr;
  }
  return out;
}

}  // namespace trocar::modeller
