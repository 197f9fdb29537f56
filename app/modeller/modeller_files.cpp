// Files that are chosen: opened, saved, imported, exported, sent to somebody.
#include <cctype>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/document/collect.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/drive/export_body.hpp>
#include <trocar/modeller/operations/first_organ.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/json/json_text.hpp>

#include "modeller/modeller_parts.hpp"

namespace trocar::app {
namespace {

constexpr Vec3d kMiddleOfThePlace{0, -150, -110};  // [mm] of scenes/modelling/place.json

/// As files name things.
std::string plain_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name.empty() ? "organ" : name;
}

}  // namespace

void Modeller::ask_for_file(FileFor what) {
  m_file_for = what;
  const bool named = m_document && !m_untitled;
  const fs::path folder = named ? m_document->root().parent_path() : fs::path();
  const std::string chosen = selected() ? selected()->name : "organ";
  switch (what) {
    case FileFor::open:
      return m_files.open({tr("Open a scene or an organ"), tr("Open"), folder, {".json"}});
    case FileFor::save_as:
      return m_files.open(
          {tr("Save as"), tr("Save"), named ? m_document->root() : fs::path("my_organ.json"), {".json"}, true});
    case FileFor::body:
      return m_files.open({m_body_by == "from_file" ? tr("Import an organ") : tr("Choose a surface to fit a NURBS to"),
                           tr("Open"),
                           {},
                           {kBodyFiles.begin(), kBodyFiles.end()}});
    case FileFor::export_body:
      return m_files.open({tr("Export {}: the ending decides the format (.stl, .obj, .ply, .vtk, .msh)", chosen),
                           tr("Export"),
                           fs::path(chosen + ".stl"),
                           {".stl", ".obj", ".ply", ".vtk", ".msh"},
                           true});
    case FileFor::send:
      return m_files.open({tr("Name of the folder for the copy"), tr("Save"), fs::path("my_organ_to_send"), {}, true});
    case FileFor::scan:
      return m_files.open(
          {tr("Open a scan: any file of a DICOM series, NIfTI, NRRD or MetaImage"), tr("Open"), {}, {}});
    case FileFor::labels:
      return m_files.open({tr("Open a label map for this scan"), tr("Open"), {}, {}});
    case FileFor::write_labels:
      return m_files.open({tr("Save the label map (.nrrd, .nii, .nii.gz)"),
                           tr("Save"),
                           fs::path("labels.seg.nrrd"),
                           {".nrrd", ".nii", ".gz"},
                           true});
    case FileFor::none:
      return;
  }
}

void Modeller::take_file(fs::path chosen) {
  const FileFor wanted = std::exchange(m_file_for, FileFor::none);
  const bool done = guarded([&] {
    switch (wanted) {
      case FileFor::open:
        m_to_open = chosen;
        m_after = After::open;
        return leave();
      case FileFor::save_as:
        return save_as(chosen);
      case FileFor::body:
        return ask_for_body(m_body_by, chosen);
      case FileFor::export_body:
        return export_chosen(chosen);
      case FileFor::send:
        return send_copy(chosen);
      case FileFor::scan:
        if (!m_document) begin_scene();
        m_scan.open(chosen);
        m_scan_shown = true;
        return;
      case FileFor::labels:
        return m_scan.take_labels(chosen);
      case FileFor::write_labels:
        return m_scan.write_labels(chosen);
      case FileFor::none:
        return;
    }
  });
  if (!done) m_after = After::none;
}

void Modeller::begin_organ() {
  guarded([this] { begin(modeller::first_organ(untitled_file(), tr("Untitled"))); });
}

void Modeller::begin_scene() {
  guarded([this] { begin(modeller::begun(untitled_file(), false, tr("Untitled"))); });
}

/// The tutorial's uterus, as a document of one's own.
void Modeller::open_sample() {
  guarded([this] {
    const fs::path file = untitled_file();
    const modeller::Document sample = modeller::Document::open(attempt::scenes_folder() / "modelling" / "uterus.json");
    const modeller::Collection copy = modeller::collected(sample, file);
    modeller::copy_files(copy);
    begin(modeller::Document::fresh(file, copy.texts.at(copy.root)));
  });
}

void Modeller::save() {
  if (m_untitled) return ask_for_file(FileFor::save_as);
  guarded([this] {
    m_document->save();
    if (m_recovery) m_recovery->forget();
    tell(tr("Saved."));
    m_log.event("saved", {{"file", m_document->root().generic_string()}});
  });
}

/// The first name that a document gets is its title, too.
void Modeller::save_as(const fs::path& file) {
  fs::path path = file;
  if (path.extension() != ".json") path += ".json";
  const fs::path before = m_document->root();
  if (m_untitled) {
    const std::string stem = path.stem().string();
    for (const auto& [key, words] : {std::pair{"title", stem}, std::pair{"name", plain_name(stem)}}) {
      scene::JsonValue s = scene::json_object();
      scene::put(s, "key", scene::json_text(key));
      scene::put(s, "value", scene::json_text(words));
      modeller::apply(*modeller::find_operation("set"), s, "here", *m_document);
    }
  }
  m_document->save_as(path);
  if (m_recovery) m_recovery->forget();
  m_is_recovered = false;
  if (std::exchange(m_untitled, false)) {
    std::error_code ignored;
    fs::remove_all(before.parent_path(), ignored);
  }
  m_recovery = std::make_unique<modeller::Recovery>(m_recovery->file().parent_path(), m_document->root());
  remember_file(m_document->root());
  m_window.set_title(tr("Trocar: {}", m_document->root().filename().string()));
  tell(tr("Saved as {}", m_document->root().generic_string()));
  m_log.event("saved", {{"file", m_document->root().generic_string()}});
  if (m_after != After::none) leave();
}

/// A folder with the document and all that it needs: it opens wherever Trocar is installed.
void Modeller::send_copy(const fs::path& folder) {
  const std::string name = m_untitled ? folder.filename().string() : m_document->root().stem().string();
  const modeller::Collection copy = modeller::collected(*m_document, folder / (name + ".json"));
  if (!copy.missing.empty())
    throw std::invalid_argument(tr("The file \"{}\", which the document names, does not exist.", copy.missing.front()));
  modeller::write_collection(copy);
  tell(tr("Written: {}. Send the whole folder.", folder.generic_string()));
  m_log.event("sent", {{"folder", folder.generic_string()}, {"files", copy.texts.size() + copy.copies.size()}});
}

void Modeller::export_chosen(const fs::path& file) {
  const std::optional<modeller::Thing> thing = selected();
  if (!thing) throw std::invalid_argument(tr("Choose the organ to export first."));
  if (!m_shown) throw std::invalid_argument(tr("There is nothing to export yet: the document has faults."));
  const std::string bytes = modeller::exported(*m_shown->built.model, thing->name, file.extension().string());
  if (const std::string said = core::write_file(file, bytes.data(), bytes.size()); !said.empty())
    throw std::invalid_argument(tr("The file cannot be written: {}", said));
  tell(tr("Exported: {}", file.generic_string()));
  m_log.event("exported", {{"file", file.generic_string()}});
}

/// What else is to be known of a body that a file shall become.
void Modeller::ask_for_body(const std::string& operation, const fs::path& file) {
  const std::string name = free_name(plain_name(file.stem().string()));
  if (operation == "from_file") return m_import.open(file, name, tissues());
  m_adding = operation;
  m_asked.clear();
  m_asked["file"] = file.generic_string();
  m_asked["name"] = name;
  m_asked["cell_mm"] = "5";
}

void Modeller::draw_import() {
  if (!m_import.draw()) return;
  std::vector<core::Fault> faults;
  const std::optional<scene::Description> d = m_document->description(faults);
  const scene::JsonValue wanted = m_import.step([&](Vec3d size_mm) {
    const std::optional<Vec3d> to = d ? modeller::place_in_view(*d, size_mm * 1e-3) : std::nullopt;
    return to ? *to * 1e3 : kMiddleOfThePlace;
  });
  if (!step(wanted)) return m_import.refuse(m_message);
  m_things = modeller::outline(*m_document);
  m_things_of = m_document->version();
  select("solid:" + m_import.name());
  if (m_import.attaches()) {
    faults.clear();
    const std::optional<scene::Description> now = m_document->description(faults);
    for (const modeller::Finding& f : modeller::readiness(*m_document, now ? &*now : nullptr, faults))
      if (f.about == modeller::Finding::About::attachment && f.thing == m_selected) do_remedy(f);
  }
  tell(tr("Imported: {}", m_import.name()));
  m_log.event("imported", {{"name", m_import.name()}});
  m_import.close();
  m_scan_shown = false;
  m_frame_when_built = true;
}

}  // namespace trocar::app
