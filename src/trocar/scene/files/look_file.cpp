#include <algorithm>
#include <system_error>

#include <trocar/core/text.hpp>
#include <trocar/scene/files/look_file.hpp>
#include <trocar/scene/files/rows.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;
using sim::Look;
using sim::Surrounding;

namespace {

const Table<Look::Relief>& relief() {
  using R = Rows<Look::Relief>;
  using L = Look::Relief;
  static const Table<L> table{
      "relief",
      "Surface detail that the mechanics do not have. It moves with the tissue.",
      {R::number("broad_mm", units::mm, &L::broad, 0, 20, "height of its larger waves, default {}"),
       R::number("broad_size_mm", units::mm, &L::broad_size, 0.5, 200, "their length, default {}"),
       R::number("fine_mm", units::mm, &L::fine, 0, 20, "height of its smaller waves, default {}"),
       R::number("fine_size_mm", units::mm, &L::fine_size, 0.5, 200, "their length, default {}"),
       R::integer("follicles", &L::follicles, 0, 100, "blisters, default {}"),
       R::number("follicle_radius_mm", units::mm, &L::follicle_radius, 0.1, 20, "of the largest, default {}"),
       R::integer("scars", &L::scars, 0, 100, "short pale furrows where follicles have burst, default {}"),
       R::number("ripe_mm", units::mm, &L::ripe, 0, 20, "radius of one ripe follicle, default {}: none"),
       R::number("lopsided_mm", units::mm, &L::lopsided, 0, 20,
                 "flat and full places of a body as a whole, each body's own, default {}"),
       R::number("haustra_mm", units::mm, &L::haustra, 0, 20, "height of a large gut's bulges, default {}"),
       R::number("haustra_size_mm", units::mm, &L::haustra_size, 1, 200, "their distance, default {}"),
       R::number("spiral_mm", units::mm, &L::spiral, 0, 2,
                 "of a strand: height of a ridge that winds around it, as a cystic duct's folds do; default {}"),
       R::number("spiral_size_mm", units::mm, &L::spiral_size, 1, 50, "its pitch, default {}")}};
  return table;
}

const Choices<Surrounding::Generator> kGenerators{
    {"fat_tags", Surrounding::Generator::fat_tags},       {"adhesions", Surrounding::Generator::adhesions},
    {"curtains", Surrounding::Generator::curtains},       {"drape", Surrounding::Generator::drape},
    {"omentum", Surrounding::Generator::omentum},         {"liver_dome", Surrounding::Generator::liver_dome},
    {"bowel_loops", Surrounding::Generator::bowel_loops}, {"porta", Surrounding::Generator::porta}};

const Table<Surrounding>& surrounding() {
  using R = Rows<Surrounding>;
  static const Table<Surrounding> table{
      "surrounding",
      "Anatomy around a body of this material, for display only.",
      {needed(R::choice("generator", kGenerators, &Surrounding::generator,
                        "the kind of anatomy: docs/guides/materials.md describes each generator")),
       R::integer("count", &Surrounding::count, 1, 200, "of fat_tags, adhesions, curtains, at most; default {}")}};
  return table;
}

void check_surrounding(const JsonObject& o, Look& look, Context&) {
  using G = Surrounding::Generator;
  const Surrounding& now = look.surroundings.back();
  const bool counted = now.generator == G::fat_tags || now.generator == G::adhesions || now.generator == G::curtains;
  if (o.has("generator") && o.has("count") && !counted)
    o.fault("count", tr("expected a count of what is counted only, got one of {}", o.text("generator")));
  for (std::size_t i = 0; i + 1 < look.surroundings.size(); ++i)
    if (o.has("generator") && look.surroundings[i].generator == now.generator)
      o.fault("generator", tr("expected every generator once, got \"{}\" again", o.text("generator")));
}

std::vector<Row<Look>> colour_rows() {
  using R = Rows<Look>;
  return {
      R::own(keys::name("inherits", "a material of the same folder that supplies the missing keys; default: neutral")),
      R::choice("surface", Choices<Look::Surface>{{"tissue", Look::Surface::tissue}, {"metal", Look::Surface::metal}},
                &Look::surface, "default {}"),
      R::vec3("colour", units::one, &Look::colour, 0, 255, "sRGB as in a picture, default {}"),
      R::vec3("patches", units::one, &Look::patches, 0, 255, "of broad patches, default {}"),
      R::vec3("flecks", units::one, &Look::flecks, 0, 255, "of fine flecks, default {}"),
      R::vec3("tint", units::one, &Look::tint, 0, 255,
              "colour of patches where something below is visible, default {}"),
      R::number("mottle_size_mm", units::mm, &Look::mottle_size, 0.1, 500, "of patches, default {}"),
      R::number("mottle", units::one, &Look::mottle, 0, 1, "share of patches and flecks, default {}"),
      R::number("lobule_size_mm", units::mm, &Look::lobule_size, 0, 100, "of lobules of fat, default {}: none"),
      R::number("lobule_depth", units::one, &Look::lobule_depth, 0, 1, "how round they are shaded, default {}"),
      R::number("lobule_contrast", units::one, &Look::lobule_contrast, 0, 1,
                "how much darker their seams are, default {}"),
      R::number("fibre_stretch", units::one, &Look::fibre_stretch, 1, 100,
                "of patterns along its fibres, grinding marks; default {}"),
      R::number("bump", units::one, &Look::bump, 0, 1, "fine unevenness, default {}")};
}

std::vector<Row<Look>> vessel_rows() {
  using R = Rows<Look>;
  return {R::own(keys::vec3("vessel_colour", 0, 255, "default: dark red"),
                 [](const JsonObject& o, Look& l, Context&) {
                   if (o.has("vessel_colour")) l.vessel_colour = o.vec3("vessel_colour");
                 }),
          R::number("vessels", units::one, &Look::vessels, 0, 4, "how much of them, default {}"),
          R::number("vessel_tile_mm", units::mm, &Look::vessel_tile, 1, 1000,
                    "edge of a tile of their picture, the largest is 1/85 of it wide; default {}"),
          R::flag("arcade", &Look::arcade, "those of a fold: bows along it, vessel_tile_mm long; default {}"),
          R::flag("lining", &Look::lining, "those of a cavity's wall: trunks with branches; default {}")};
}

std::vector<Row<Look>> film_rows() {
  using R = Rows<Look>;
  return {R::number("roughness", units::one, &Look::roughness, 0.02, 1, "of what is under the film, default {}"),
          R::number("wetness", units::one, &Look::wetness, 0, 1, "0 dry, 1 film everywhere; default {}"),
          R::number("film_roughness", units::one, &Look::film_roughness, 0.02, 0.5,
                    "sharp: broken flecks, blunt: sheen; default {}"),
          R::number("film_size_mm", units::mm, &Look::film_size, 0.1, 50, "length of the film's ripples, default {}"),
          R::number("film_bump", units::one, &Look::film_bump, 0, 1, "how much they break highlights up, default {}"),
          R::number("fresnel", units::one, &Look::fresnel, 0, 1, "reflectance at normal incidence, default {}"),
          R::vec3("wrap", units::one, &Look::wrap, 0, 1,
                  "width of scattered light around edges, red, green, blue; default {}"),
          R::vec3("glow", units::one, &Look::glow, 0, 1, "colour of light through a thin rim, linear; default {}"),
          R::number("glow_amount", units::one, &Look::glow_amount, 0, 1, "of that, default {}"),
          R::number("alpha", units::one, &Look::alpha, 0, 1,
                    "opacity of a translucent surface that faces the viewer; default {}"),
          R::number("rim_alpha", units::one, &Look::rim_alpha, 0, 1, "opacity edge on, default {}"),
          R::flag("translucent", &Look::translucent, "true: objects behind it are visible through it, default {}"),
          R::flag("moulded", &Look::moulded,
                  "true: an artificial model without a smooth transition to its attachments, default {}"),
          R::flag("two_sided", &Look::two_sided, "true: both sides are drawn, default {}"),
          R::number("scatter", units::one, &Look::scatter, 0, 1, "of metal: 0 bare, 1 ceramic or plastic; default {}"),
          R::number("soil", units::one, &Look::soil, 0, 1, "of metal: share of blood and burn that shows, default {}")};
}

const Table<Look>& look_keys() {
  using R = Rows<Look>;
  static const Table<Look> table{
      "look", "A material: the appearance of a surface, and anatomy that is drawn around it.", [] {
        std::vector<Row<Look>> rows = colour_rows();
        for (const std::vector<Row<Look>>& more : {vessel_rows(), film_rows()})
          rows.insert(rows.end(), more.begin(), more.end());
        rows.push_back(R::object("relief", relief, &Look::relief, "default: smooth"));
        rows.push_back(
            R::objects("surroundings", surrounding, &Look::surroundings, 0, "default: none", check_surrounding));
        return of_file(std::move(rows));
      }()};
  return table;
}

constexpr std::size_t kMostInherited = 16;

}  // namespace

MaterialFolders::MaterialFolders(const std::vector<fs::path>& folders, std::vector<core::Fault>& faults,
                                 const MemoryFiles* memory)
    : m_faults(faults), m_memory(memory) {
  for (const fs::path& folder : folders) {
    std::error_code error;
    if (!MemoryFiles::disk_too(memory)) {
      for (const auto& [path, text] : *memory)
        if (path.parent_path() == folder && path.extension() == ".json") m_files.emplace(path.stem().string(), path);
      continue;
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == ".json") m_files.emplace(entry.path().stem().string(), entry.path());
  }
  auto library = std::make_shared<sim::MaterialLibrary>();
  for (const auto& [name, path] : m_files) {
    Open open;
    library->looks.push_back(look(name, open));
  }
  m_library = std::move(library);
}

std::vector<std::string> MaterialFolders::names() const {
  std::vector<std::string> all;
  for (const auto& [name, path] : m_files) all.push_back(name);
  return all;
}

const Look& MaterialFolders::look(const std::string& name, Open& open) {
  if (const auto read = m_read.find(name); read != m_read.end()) return read->second;
  open.push_back(name);
  const JsonDocument document = load_json(m_files.at(name), m_faults, m_memory);
  const JsonObject o(document.root, look_keys(), document.file, m_faults);
  Look look;
  inherit(o, look, open);
  look.name = name;
  if (o.names("surroundings")) look.surroundings.clear();
  std::vector<Reference> none;
  Context context{{}, nullptr, none};
  look_keys().read(o, look, context);
  open.pop_back();
  return m_read.emplace(name, std::move(look)).first->second;
}

void MaterialFolders::inherit(const JsonObject& o, Look& look, Open& open) {
  if (!o.has("inherits")) return;
  const std::string base = o.text("inherits");
  std::string chain;
  for (const std::string& name : open) chain += name + " -> ";
  if (m_files.count(base) == 0)
    o.fault("inherits", unknown_name("look", base, names()));
  else if (std::find(open.begin(), open.end(), base) != open.end())
    o.fault("inherits", tr("expected materials that do not inherit each other in a cycle, got {}{}", chain, base));
  else if (open.size() >= kMostInherited)
    o.fault("inherits", tr("expected at most {} materials that inherit each other, got more", kMostInherited));
  else
    look = this->look(base, open);
}

const Shape& look_shape() { return look_keys(); }

}  // namespace trocar::scene
