// A modeller at work without a window: a document, what it compiles to, a test drive, and pictures. A script's steps
// are its commands; a window does the same things by hand.
//
//   Session session({.shots = "pictures"});
//   run_script("uterus.json", session);
//
// A step of a script is an operation (operations/operation.hpp) or one of commands(): open, save, undo, build, take,
// shot ...
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <trocar/core/json.hpp>
#include <trocar/modeller/document/document.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/modeller/drive/test_drive.hpp>
#include <trocar/modeller/operations/operation.hpp>
#include <trocar/modeller/picture/easel.hpp>
#include <trocar/modeller/scan/scan.hpp>

namespace trocar::modeller {

struct SessionOptions {
  fs::path shots;  ///< folder of pictures; empty: none are drawn
  int width = 960, height = 720;
};

class Session {
 public:
  explicit Session(SessionOptions options = {}) : m_options(std::move(options)) {}

  bool has_document() const { return m_document.has_value(); }
  Document& document();  ///< @throws core::BadInput where none is open
  void put(Document document);

  Scan& scan();  ///< @throws core::BadInput where none was read
  void put(Scan scan) { m_scan = std::move(scan); }

  /// What the document as it is now compiles to; made when it is first asked for.
  const Built& built();
  /// The same where it is good. @throws core::BadInput with its faults
  const sim::Model& model();
  TestDrive& drive();  ///< begins where there is none
  bool drives() const { return m_drive != nullptr; }
  void stop_driving() { m_drive.reset(); }

  /// A picture more. @param thing  whose points are shown; empty: none
  void shot(const std::string& name, const std::string& thing, const std::string& of, double yaw, double pitch,
            double distance, bool scope);
  /// One that somebody else drew.
  void keep_picture(const std::string& name, const render::Image& image);
  bool draws() const { return !m_options.shots.empty(); }

  Json& said() { return m_said; }  ///< what steps have to say, for the result
  const std::vector<std::string>& pictures() const { return m_pictures; }

 private:
  SessionOptions m_options;
  std::optional<Document> m_document;
  std::optional<Scan> m_scan;
  Built m_built;
  bool m_is_built = false;
  std::unique_ptr<TestDrive> m_drive;
  std::unique_ptr<Easel> m_easel;
  const sim::Model* m_shown = nullptr;
  std::vector<std::string> m_pictures;
  Json m_said = Json::array();
};

/// A step that is no operation on the document.
struct Command {
  scene::Shape parameters;
  std::function<void(const scene::JsonObject& o, Session& session)> run;
};
const std::vector<Command>& commands();
const Command* find_command(std::string_view name);

/// Does one step. @throws core::BadInput
void run_step(const scene::JsonValue& step, const std::string& file, Session& session);

/// Does all steps of a script file. Names of files in it are relative to `folder` where it is not empty, else to where
/// the program runs. @throws core::BadInput at the first step that cannot be done
struct ScriptResult {
  int steps = 0;
  int operations = 0;
};
ScriptResult run_script(const fs::path& script, Session& session);

}  // namespace trocar::modeller
