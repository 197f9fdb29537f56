#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/files/look_file.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/reader_parts.hpp>
#include <trocar/scene/files/scene_folders.hpp>
#include <trocar/scene/files/vessel_file.hpp>
#include <trocar/scene/json/like.hpp>
#include <trocar/scene/mechanisms/instrument_mechanism.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMaxIncludeDepth = 16;

/// Faults in the order in which a person meets them: file by file as read, then by place.
void sort_faults(std::vector<core::Fault>& faults) {
  std::vector<std::string> files;
  const auto rank = [&](const core::Fault& f) {
    return std::find(files.begin(), files.end(), f.at.file) - files.begin();
  };
  for (const core::Fault& f : faults)
    if (rank(f) == std::ptrdiff_t(files.size())) files.push_back(f.at.file);
  std::stable_sort(faults.begin(), faults.end(), [&](const core::Fault& a, const core::Fault& b) {
    const auto ra = rank(a), rb = rank(b);
    if (ra != rb) return ra < rb;
    return a.at.line != b.at.line ? a.at.line < b.at.line : a.at.column < b.at.column;
  });
}

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

/// A file that one on the disk names, also where it comes with the program.
fs::path found(const fs::path& path, const MemoryFiles* memory) {
  const bool in_memory = memory && memory->text_of(path);
  return in_memory || !MemoryFiles::disk_too(memory) ? path : located(path);
}

}  // namespace

void Reading::include(const fs::path& path, const core::Location& from, const Shape& shape, const Read& read) {
  const auto refuse = [&](std::string message) { tell(m_faults, {from, std::move(message)}); };
  std::error_code error;
  const bool disk = MemoryFiles::disk_too(m_memory);
  if (disk && m_open.empty()) m_library.emplace(path);
  const fs::path canonical = disk ? fs::weakly_canonical(path, error) : path;
  std::string chain;
  bool cycle = false;
  for (const auto& [open, name] : m_open) {
    cycle = cycle || open == canonical;
    if (cycle) chain += name + " -> ";
  }
  if (cycle)
    return refuse(
        tr("expected files that do not include each other in a cycle, got {}{}", chain, path.generic_string()));
  if (m_open.size() >= kMaxIncludeDepth)
    return refuse(tr("expected at most {} files inside each other, got more", kMaxIncludeDepth));
  if (++m_files > kMaxFiles) return refuse(tr("expected at most {} files, got more", kMaxFiles));
  const bool there = (m_memory && m_memory->text_of(path)) || (disk && fs::is_regular_file(path, error));
  if (!m_open.empty() && !there)
    return refuse(tr("expected the name of a file, got \"{}\" (there is no file {})", path.filename().generic_string(),
                     path.generic_string()));
  m_open.emplace_back(canonical, path.generic_string());
  const JsonDocument document = load_json(path, m_faults, m_memory);
  const bool is_like = shape.find(kLike) && document.root.find(kLike);
  const Shape less = is_like ? like_another(shape) : Shape{};
  read(JsonObject(document.root, is_like ? less : shape, document.file, m_faults), path.parent_path());
  m_open.pop_back();
}

fs::path Reading::place_of(const fs::path& folder, const fs::path& named) const {
  return found((folder / named).lexically_normal(), m_memory);
}

void Reading::include_named(const JsonObject& o, const core::Location& at, const JsonValue& name,
                            const fs::path& folder, const Shape& shape, const Read& read) {
  const fs::path named(name.text);
  if (named.empty() || named.is_absolute())
    o.fault(at, tr("expected a file name relative to this file, got {}", shown(name)));
  else if (const fs::path path = place_of(folder, named); m_library && !m_library->holds(path))
    o.fault(at, m_library->refusal(name.text));
  else
    include(path, at, shape, read);
}

void Reading::includes(const JsonObject& o, const char* key, const fs::path& folder, const Shape& shape,
                       const Read& read, const Read& read_here) {
  const std::vector<JsonValue>& items = o.values(key);
  for (std::size_t i = 0; i < items.size(); ++i)
    if (items[i].kind == JsonValue::Kind::string) include_named(o, o.at(key, i), items[i], folder, shape, read);
  for (const JsonObject& object : o.objects(key)) read_here(object, folder);
}

void Reading::scene_file(const fs::path& path) {
  std::vector<Layer> layers;
  include(path, {path.generic_string(), 0, 0}, scene_file_keys(),
          [&](const JsonObject& o, const fs::path& folder) { scene(o, folder, layers); });
}

void Reading::scene(const JsonObject& o, const fs::path& folder, std::vector<Layer>& layers) {
  layers.push_back({o, folder});
  bool read = false;  // with the layers below
  if (o.has(kLike))
    include_named(o, o.at(kLike), o.value().find(kLike)->value, folder, scene_file_keys(),
                  [&](const JsonObject& below, const fs::path& its_folder) {
                    read = true;
                    scene(below, its_folder, layers);
                  });
  if (!read) scene_of(layers);
}

void Reading::scene_of(const std::vector<Layer>& layers) {
  for (const Row<Description>& row : scene_file_keys().rows) {
    const auto end = is_own(row.key.name) ? layers.begin() + 1 : layers.end();
    const auto says = std::find_if(layers.begin(), end, [&](const Layer& l) { return l.o.names(row.key.name); });
    const Layer& layer = says == end ? layers.front() : *says;
    Context context{layer.folder, this, m_references};
    if (row.read) row.read(layer.o, description, context);
  }
  Context context{layers.front().folder, this, m_references};
  scene_file_keys().check(layers.front().o, description, context);
}

void Reading::instrument_file(const fs::path& path) {
  include(path, {path.generic_string(), 0, 0}, instrument_file_keys(),
          one_more(instrument_file_keys(), description.instruments));
}

void Reading::tissues(const JsonObject& o, const fs::path& folder) {
  includes(o, "tissues", folder, tissue_file_keys(), into(tissue_file_keys()), one_more(tissue(), description.tissues));
}

void Reading::organs(const JsonObject& o, const fs::path& folder) {
  includes(o, "organs", folder, organ_file_keys(), into(organ_file_keys()), into(organ_keys()));
}

void Reading::instruments(const JsonObject& o, const fs::path& folder) {
  includes(o, "instruments", folder, instrument_file_keys(), one_more(instrument_file_keys(), description.instruments),
           one_more(instrument(), description.instruments));
}

void Reading::vessels(const JsonObject& o, const fs::path& folder) {
  const Read read = [this](const JsonObject& file, const fs::path&) {
    VesselTree tree = read_vessels(file, m_faults);
    for (const Vessel& v : tree.vessels)
      for (std::size_t i = 0; i < v.rides_on.size(); ++i)
        m_references.push_back({Reference::To::carrier, v.rides_on[i], v.rides_at[i]});
    if (tree.says_heart && !description.vessels.empty())
      tell(m_faults, {tree.heart_at,
                      "expected heart and blood of a patient in the scene's first file of vessels, got some "
                      "in a second one"});
    description.vessels.push_back(std::move(tree));
  };
  includes(o, "vessels", folder, vessels_shape(), read, read);
}

void Reading::variant(const JsonObject& o, const fs::path& folder, VariationSetting& variation) {
  const std::size_t first = m_references.size();
  Context context{folder, this, m_references};
  variation.variants.push_back(variant_keys().made(o, context));
  const auto of_scene = [](const Reference& r) { return r.to == Reference::To::look; };
  const auto own = std::stable_partition(m_references.begin() + std::ptrdiff_t(first), m_references.end(), of_scene);
  m_of_variants.emplace_back(own, m_references.end());
  m_references.erase(own, m_references.end());
}

void Reading::variant_bodies(const JsonObject& o, const fs::path& folder, VariationSetting::Variant& variant) {
  Description brings;
  swap_bodies(description, brings);  // files fill the description
  organs(o, folder);
  vessels(o, folder);
  Context context{folder, this, m_references};
  for (const JsonObject& one : o.objects("marks")) description.marks.push_back(mark().made(one, context));
  swap_bodies(description, brings);
  variant.brings = std::make_shared<const Description>(std::move(brings));
}

Description read_scene(const fs::path& path, const MemoryFiles* memory) {
  std::vector<core::Fault> faults;
  Reading reading(faults, memory);
  reading.scene_file(path);
  reading.looks(path);
  reading.resolve();
  reading.check_together();
  sort_faults(faults);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return std::move(reading.description);
}

FileKind kind_of_file(const fs::path& path, const MemoryFiles* memory) {
  std::vector<core::Fault> ignored;
  const JsonDocument document = load_json(path, ignored, memory);
  const auto has = [&](const char* key) { return document.root.find(key) != nullptr; };
  if (path.parent_path().filename() == "looks") return FileKind::look;
  if (has("scene")) return FileKind::exercise;
  if (has("like") || has("scope") || has("ports") || has("tools")) return FileKind::scene;
  if (has("vessels") || has("sources")) return FileKind::vessels;
  if (has("inherits") || has("colour") || has("surroundings")) return FileKind::look;
  if (has("kind")) return FileKind::instrument;
  for (const char* bodies : {"solids", "strands", "walls", "sheets", "membranes", "pouches", "organs"})
    if (has(bodies)) return FileKind::organ;
  return has("tissues") ? FileKind::tissue : FileKind::scene;
}

std::vector<Tissue> read_tissues(const fs::path& path) {
  std::vector<core::Fault> faults;
  Reading reading(faults, nullptr);
  reading.tissue_file(path);
  sort_faults(faults);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return std::move(reading.description.tissues);
}

namespace {

/// What compiling would find: a linkage that does not close its jaws, hinges that no instrument bends at.
void check_mechanisms(const Description& description, std::vector<core::Fault>& faults) {
  for (const Instrument& i : description.instruments) {
    interactions::ToolModel tool;
    take_linkage(i, tool, faults);
    take_wrist(i, tool, faults);
  }
}

}  // namespace

std::vector<core::Fault> check_file(const fs::path& path, const MemoryFiles* memory) {
  std::vector<core::Fault> faults;
  Reading reading(faults, memory);
  switch (kind_of_file(path, memory)) {
    case FileKind::scene:
      reading.scene_file(path);
      reading.looks(path);
      reading.resolve();
      break;
    case FileKind::organ:
      reading.organ_file(path);
      reading.looks(path);
      break;
    case FileKind::look:
      MaterialFolders({path.parent_path()}, faults, memory);
      break;
    case FileKind::instrument:
      reading.instrument_file(path);
      if (faults.empty()) check_mechanisms(reading.description, faults);
      break;
    case FileKind::tissue:
      reading.tissue_file(path);
      break;
    case FileKind::vessels:
      read_vessels(path, faults, memory);
      break;
    case FileKind::exercise:
      load_json(path, faults, memory);
      break;
  }
  reading.check_together();
  sort_faults(faults);
  return faults;
}

std::vector<SceneEntry> list_scenes(const fs::path& folder) {
  std::vector<SceneEntry> entries;
  for (const fs::path& path : sorted_entries(folder)) {
    const fs::path file = path / "scene.json";
    std::error_code error;
    if (!fs::is_regular_file(file, error)) continue;
    std::vector<core::Fault> ignored;
    const JsonDocument document = load_json(file, ignored);
    const JsonMember* title = document.root.find("title");
    entries.push_back({path.filename().generic_string(), title ? core::printable(title->value.text) : "", file});
  }
  return entries;
}

std::vector<InstrumentEntry> list_instruments(const fs::path& folder) {
  std::vector<InstrumentEntry> entries;
  for (const fs::path& path : sorted_entries(folder)) {
    std::vector<core::Fault> faults;
    if (path.extension() != ".json") continue;
    const JsonDocument document = load_json(path, faults);
    const JsonObject o(document.root, instrument_shape(), document.file, faults);
    if (faults.empty()) entries.push_back({o.text("name"), o.text("kind"), core::printable(o.text("title")), path});
  }
  return entries;
}

const Shape& scene_shape() { return scene_file_keys(); }
const Shape& organ_shape() { return organ_file_keys(); }
const Shape& instrument_shape() { return instrument_file_keys(); }
const Shape& tissue_shape() { return tissue_file_keys(); }

}  // namespace trocar::scene
