// The modeller's window: what it holds, in the order in which a picture is made of it. Private to the folder.
#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/modeller/document/recovery.hpp>
#include <trocar/modeller/drive/places.hpp>
#include <trocar/modeller/drive/test_drive.hpp>
#include <trocar/modeller/materials/materials.hpp>
#include <trocar/modeller/operations/operation.hpp>
#include <trocar/render/frame/governor.hpp>
#include <trocar/render/gl/gl_context.hpp>

#include "modeller/builder.hpp"
#include "modeller/file_panel.hpp"
#include "modeller/gesture.hpp"
#include "modeller/gizmo.hpp"
#include "modeller/import_panel.hpp"
#include "modeller/modeller.hpp"
#include "modeller/scan_desk.hpp"
#include "modeller/viewport.hpp"
#include "shell/child_program.hpp"
#include "shell/event_log.hpp"
#include "shell/ui.hpp"
#include "shell/window.hpp"

struct ImDrawList;

namespace trocar::app {

namespace fs = std::filesystem;

/// Endings of files that a body can be made of.
inline constexpr std::array kBodyFiles = {".obj", ".stl",  ".ply", ".glb",  ".gltf", ".vtk",
                                          ".msh", ".step", ".stp", ".iges", ".igs"};

class Modeller {
 public:
  Modeller(Window& window, const ModellerOptions& options, EventLog& log);

  void open(const fs::path& file);
  void run();

 private:
  /// What a file is chosen for.
  enum class FileFor { none, open, save_as, scan, labels, write_labels, body, export_body, send };

  // modeller.cpp: the round of a picture
  void picture();
  void draw_all();
  void draw_dialogues();
  void lay_out();
  void take_what_is_built();
  void keep_unsaved();
  void leave();
  void recover_from(const std::string& why);
  void take(std::unique_ptr<modeller::Document> document);
  void begin(modeller::Document document);
  fs::path untitled_file() const;
  void forget_untitled();
  bool needs_saving() const;

  // modeller_operate.cpp
  void operate();
  void continue_operating();
  void start_trainer();
  void watch_trainer();
  void do_remedy(const modeller::Finding& finding);
  void draw_checks();
  void draw_trainer_report();
  const std::vector<modeller::Finding>* findings_now() const;

  // modeller_files.cpp
  void ask_for_file(FileFor what);
  void take_file(fs::path chosen);
  void ask_for_body(const std::string& operation, const fs::path& file);
  void save();
  void save_as(const fs::path& file);
  void send_copy(const fs::path& folder);
  void begin_organ();
  void begin_scene();
  void open_sample();
  void export_chosen(const fs::path& file);
  void draw_import();

  // modeller_keys.cpp
  void listen();
  void obey_key(int key, int mods);
  void obey_key_of_gesture(int key);
  void take_dropped(const std::string& path);
  bool close_top();
  bool asks() const;

  // modeller_view.cpp: pictures and the pointer over them
  void draw_views();
  void draw_view(Viewport& view);
  void draw_over_views();
  void draw_handles(const Viewport& view) const;
  void place_gizmo();
  void draw_points(const Viewport& view, ImDrawList& list) const;
  void point();
  void point_in(Viewport& view);
  std::optional<GizmoPart> pointed_part(const Viewport& view) const;
  Viewport* view_under(float x, float y);
  void pick(const Viewport& view, float x, float y);
  void draw_point(const Viewport& view, float x, float y);
  void end_drawing(bool keep);
  static bool is_one_place(const std::string& operation);
  void hold_here();
  void frame_selected();
  void look_from(int which);

  // modeller_brush.cpp
  void toggle_brush();
  std::optional<Vec3d> on_chosen(const Viewport& view, float x, float y) const;
  void brush_in(Viewport& view);
  void end_stroke();
  void draw_brush_over(const Viewport& view) const;
  void draw_brush_panel();

  // modeller_gestures.cpp
  void begin_gesture(Gesture::Kind kind);
  void begin_gizmo(const GizmoPart& part, float x, float y);
  void begin_drag(const modeller::Handle& handle, float x, float y);
  void preview_gesture();
  void lead_gesture();
  void end_gesture(bool keep);
  std::optional<scene::JsonValue> step_of_gesture(std::string& amount) const;
  std::optional<Vec3d> onto_other_body(const Viewport& view, float x, float y) const;

  // modeller_panels.cpp
  void draw_menu_bar();
  void draw_file_menu();
  void draw_edit_menu();
  void draw_add_menu();
  void draw_scene_menu();
  void draw_view_menu();
  void draw_outline();
  void draw_properties();
  void draw_status();
  void draw_faults();
  void draw_start();
  void draw_help();
  void draw_questions();
  void draw_adding();
  void draw_fields_of(const modeller::Operation& operation);
  void do_adding(const modeller::Operation& operation);
  void ask_to_save();
  void ask_to_recover();
  void recover(const modeller::Lost& lost);

  // modeller_properties.cpp
  void draw_thing(const modeller::Thing& thing);
  void draw_keys(const scene::Shape& shape, const scene::JsonValue& value, const std::string& path, int depth);
  void draw_key(const scene::Key& key, const scene::JsonValue* value, const std::string& path, int depth);
  std::optional<scene::JsonValue> edited(const scene::Key& key, const scene::JsonValue* value, const std::string& id);
  void draw_read_outs(const modeller::Thing& thing);
  void draw_size_and_load(const modeller::ReadOut& read_out);
  void draw_overview();
  void draw_tissue(const std::string& tissue);
  void choose_tissue_of_selected(const scene::JsonValue* value);
  bool choose_tissue(const std::string& thing, std::string name);
  const std::vector<modeller::TissueChoice>& tissues();

  // changes
  /// Does a step of a script. False: it could not be done, and why is told.
  bool step(scene::JsonValue step);
  bool set_key(const std::string& path, const scene::JsonValue& value);
  /// A line in grey, where one looks for it; or one in orange with a mark: it could not be done, and why.
  void tell(const std::string& what) { m_message = what, m_is_error = false; }
  void warn(const std::string& what) { m_message = what, m_is_error = true; }
  /// Does something that files or people may make impossible. False: it could not be done, and why is shown.
  template <class Do>
  bool guarded(Do&& act);
  void select(const std::string& thing);
  std::optional<modeller::Thing> selected() const;
  void undo();
  void redo();
  void remember_file(const fs::path& file);
  std::string free_name(const std::string& stem) const;

  // test drive
  void toggle_drive();
  void drive_on();

  // modeller_scan.cpp
  bool scan_shown() const { return m_scan_shown && (m_scan.shows() || m_scan.reads() || m_scan.asks()); }
  void draw_scan();
  void draw_scan_menu();
  void make_organ(const std::string& segment);

  void log_widgets();
  float text_height() const { return 19 * m_window.scale(); }

  Window& m_window;
  ModellerOptions m_options;
  EventLog& m_log;
  std::unique_ptr<render::GlContext> m_context;
  std::unique_ptr<render::Backend> m_backend;
  render::Governor m_governor;

  std::unique_ptr<modeller::Document> m_document;
  std::unique_ptr<modeller::Recovery> m_recovery;
  std::vector<modeller::Thing> m_things;
  std::uint64_t m_things_of = ~0ull;
  std::string m_selected;

  Builder m_builder;
  std::unique_ptr<BuiltDocument> m_built;     ///< the newest, good or not
  std::unique_ptr<BuiltDocument> m_shown;     ///< the newest good one: what is drawn
  std::unique_ptr<view::SceneView> m_view;    ///< of m_shown's model
  std::optional<sim::State> m_state;          ///< as drawn
  std::vector<modeller::BodyPlace> m_places;  ///< of m_state
  std::uint64_t m_picture = 0;                ///< another number: views are drawn anew
  std::unique_ptr<modeller::TestDrive> m_drive;
  bool m_taking = false;    ///< the pointer holds the grasper's goal
  double m_drive_debt = 0;  ///< simulated time that is owed [s]

  std::array<Viewport, 4> m_views;
  bool m_four = false;
  int m_active = 0;  ///< the view that keys turn
  modeller::Handles m_handles;
  std::uint64_t m_handles_of = ~0ull;
  std::string m_handles_thing;
  std::optional<modeller::Handle> m_handle;  ///< taken last
  Gizmo m_gizmo;                             ///< of the chosen thing, or of the point that was taken
  std::optional<Gesture> m_gesture;
  bool m_previewed = false;        ///< the document's last change is the gesture's so far
  std::set<std::string> m_hidden;  ///< names of what is not shown
  bool m_instruments = false;      ///< shown: they stand in front of what is modelled
  bool m_soft = false, m_symmetric = false;
  bool m_snap = false;  ///< what is moved goes onto the body under the pointer
  struct Brush {
    bool on = false, erases = false;
    std::string what = "hold";  ///< as the operation `paint` calls it
    double radius_mm = 8, stiffness = 2;
    std::vector<Vec3d> stroke;  ///< [m] so far
  } m_brush;
  double m_soft_mm = 20;
  std::vector<Vec3d> m_measured;  ///< [m] places that were clicked
  bool m_measuring = false;
  std::string m_draw_for;      ///< the operation for which a line is drawn by clicking; empty: none
  std::vector<Vec3d> m_drawn;  ///< [m] its points so far
  std::string m_drawn_on;      ///< the body that the last one is on; empty: none

  ScanDesk m_scan;
  std::optional<LostSegments> m_lost_segments;
  bool m_scan_shown = false;  ///< else the document

  FilePanel m_files;
  FileFor m_file_for = FileFor::none;
  std::string m_body_by;  ///< the operation that takes the file of a body
  enum class Question { none, unsaved, save_and_operate, recover } m_question = Question::none;
  enum class After { none, quit, open, start, begin } m_after = After::none;
  std::unique_ptr<modeller::Document> m_to_begin;  ///< After::begin
  bool m_untitled = false;                         ///< the document has no file of the user's yet
  bool m_drop_changes = false;
  bool m_is_recovered = false;  ///< it was never saved, whatever its history says
  fs::path m_to_open;
  std::vector<modeller::Lost> m_lost;
  std::vector<fs::path> m_recent;
  bool m_help = false, m_quit = false, m_history = false, m_faults = false;
  std::string m_adding;  ///< name of the operation whose parameters are asked for
  std::map<std::string, std::string> m_asked;
  std::map<std::string, std::string> m_texts;              ///< fields that are being edited, by their key's path
  std::map<std::string, std::array<double, 3>> m_numbers;  ///< the same
  std::string m_message;
  bool m_is_error = false;

  ImportPanel m_import;
  bool m_wants_operate = false;  ///< as soon as the document is compiled
  bool m_checks = false;         ///< what it lacks is shown
  bool m_frame_when_built = false;
  std::vector<modeller::Finding> m_findings;
  std::uint64_t m_findings_of = ~0ull;  ///< version
  std::string m_choosing_for;           ///< a thing whose tissue is chosen
  std::optional<ChildProgram> m_trainer;
  bool m_trainer_is_up = false;
  std::optional<int> m_trainer_status;  ///< of one that has failed, until it was read
  std::string m_trainer_said;
  std::vector<modeller::TissueChoice> m_tissues;
  std::uint64_t m_tissues_of = ~0ull;
  std::chrono::steady_clock::time_point m_kept{};
  Area m_left, m_right, m_middle, m_bottom;
  float m_bar = 0;      ///< height of the menu bar [px]
  bool m_held = false;  ///< the test drive's grasper, as logged
  std::vector<ui::Widget> m_widgets;
  Json m_logged_points;
};

template <class Do>
bool Modeller::guarded(Do&& act) {
  try {
    act();
    return true;
  } catch (const core::BadInput& bad) {
    warn(bad.faults().empty() ? bad.what() : bad.faults().front().message);
  } catch (const std::exception& failed) {
    warn(failed.what());
  }
  m_log.event("refused", {{"said", m_message}});
  return false;
}

}  // namespace trocar::app
