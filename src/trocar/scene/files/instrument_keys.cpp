// Keys of instrument files.
#include <filesystem>
#include <map>

#include <trocar/core/text.hpp>
#include <trocar/scene/files/keys.hpp>
#include <trocar/scene/files/reader_parts.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

namespace {

const Table<ElectrodeSetting>& electrode() {
  using R = Rows<ElectrodeSetting>;
  using E = ElectrodeSetting;
  static const Table<E> table{
      "electrode",
      "The part of a hook or of bipolar forceps that current leaves from; without this key, with the defaults.",
      {R::number("radius_mm", units::mm, &E::radius, 0.5, 1.5, "of its contact with tissue, default {}"),
       R::number("efficiency", units::one, &E::efficiency, 0.3, 0.6,
                 "share of the generator's power that heats tissue, default {}"),
       R::number("stick_force_N", units::one, &E::stick_force, 0, 20, "that tears it off char, default {}"),
       R::number("seals_mm", units::mm, &E::seals, 0.1, 10,
                 "largest outer diameter of vessels that it seals, default 1, between jaws 3")}};
  return table;
}

const Table<NeedleSetting>& needle() {
  using R = Rows<NeedleSetting>;
  using N = NeedleSetting;
  static const Table<N> table{
      "needle",
      "What comes out of an injection needle's shaft, and the syringe behind it.",
      {R::number("length_mm", units::mm, &N::length, 2, 60, "beyond the shaft when it is out, default {}"),
       R::number("diameter_mm", units::mm, &N::diameter, 0.3, 3, "default {}: 22 G"),
       R::number("bore_mm", units::mm, &N::bore, 0.1, 2.8, "inner diameter, default {}"),
       R::number("plunger_mm", units::mm, &N::plunger, 2, 50, "inner diameter of the syringe, default {}"),
       R::number("holds_mL", units::millilitre, &N::holds, 0.1, 100, "in the syringe at the start, default {}"),
       R::number("flow_mL_min", units::millilitre, &N::flow, 0.1, 600,
                 "volume that a hand intends to inject, default {}"),
       R::number("most_force_N", units::one, &N::most_force, 1, 200, "force of the thumb on the plunger, default {}"),
       R::number("drug_IU_mL", units::one, &N::units, 0, 1000,
                 "of a drug that narrows vessels, vasopressin; default {}: saline, which does not")},
      [](const JsonObject& o, N& n, Context&) {
        if (!(n.bore < n.diameter)) o.fault("bore_mm", "expected less than diameter_mm, got no less");
      }};
  return table;
}

/// A mechanism, which is read with what names it. By its name a copy of a scene finds it wherever that lies.
template <class T, class Member>
Row<T> mechanism_row(const char* name, Member member, const std::string& meaning) {
  const auto file = [member](auto& t) -> auto& { return std::invoke(member, t).file; };
  Row<T> row = Rows<T>::text(name, file, meaning);
  row.read = [=, read = row.read](const JsonObject& o, T& t, Context& c) {
    read(o, t, c);
    if (c.reading) c.reading->mechanism_of(o, name, c.folder, std::invoke(member, t));
  };
  return row;
}

const Table<WristSetting>& wrist() {
  using R = Rows<WristSetting>;
  using W = WristSetting;
  static const Table<W> table{
      "wrist",
      "What bends between shaft and jaws: two hinges, the first up and down in the plane of the jaws' hinge, the "
      "second "
      "aside; or the hinges of a mechanism.",
      {R::number("between_mm", units::mm, &W::between, 0, 50, "from the first hinge to the second, default {}"),
       R::number("after_mm", units::mm, &W::after, 0, 50, "from there to the jaws' hinge, default {}"),
       R::number("pitch_deg", units::deg, &W::pitch, 0, 120,
                 "range of the first hinge in each direction, default {:.0f}"),
       R::number("yaw_deg", units::deg, &W::yaw, 0, 120, "range of the second hinge, default {:.0f}"),
       mechanism_row<W>("mechanism", &W::mechanism,
                        "a mechanism, by its name in a library or its file from this one on: what follows on its link "
                        "'shaft' up to its frame "
                        "'tip'. With more than two joints the hand controls the tip, and the chain follows")},
      [](const JsonObject& o, W& w, Context&) {
        w.there = true;
        for (const char* key : {"between_mm", "after_mm", "pitch_deg", "yaw_deg"})
          if (o.has("mechanism") && o.has(key))
            o.fault(key, "expected no other key beside mechanism, which defines the bending, got a number");
      }};
  return table;
}

Choices<interactions::ToolKind> kinds() {
  Choices<interactions::ToolKind> out;
  for (const interactions::KindOfTool& k : interactions::kToolKinds) out.emplace_back(k.name, k.kind);
  return out;
}

std::vector<Row<Instrument>> instrument_rows() {
  using R = Rows<Instrument>;
  using I = Instrument;
  return {
      needed(R::name("name", &I::name, "its name in scenes")),
      R::text("title", &I::title, "one line for lists"),
      needed(R::choice("kind", kinds(), &I::kind, "what it does")),
      R::number("shaft_diameter_mm", units::diameter, &I::shaft_radius, 1, 30, "default {}"),
      R::number("shaft_length_mm", units::mm, &I::shaft_length, 50, 1000,
                "from the handle to the jaws' joint, default {}"),
      R::number("jaw_length_mm", units::mm, &I::jaw_length, 1, 100, "default {}"),
      R::number("jaw_width_mm", units::mm, &I::jaw_width, 0.2, 30, "default {}"),
      R::number("jaw_thickness_mm", units::mm, &I::jaw_thickness, 0.2, 20, "of one jaw, default {}"),
      R::number("opening_deg", units::deg, &I::opening, 0, 180, "between the open jaws, default {:.0f}")
          .only([](const I& i) { return !(i.parallel_gap > 0) && i.linkage.file.empty(); }),
      R::number("parallel_gap_mm", units::mm, &I::parallel_gap, 0, 50,
                "between parallel jaws when open, default {}: they turn"),
      R::number("foot_mm", units::mm, &I::foot, 0, 20,
                "of a hook: from its wire's axis to the foot's end, to where jaws would open, default {}: it has none"),
      R::number("pinch_max_N", units::one, &I::pinch_max, 0, 200,
                "between the jaws with the handle closed, default {}"),
      R::number("friction", units::one, &I::friction, 0, 10, "largest pull of the grip per pinch force, default {}"),
      R::number("clip_length_mm", units::mm, &I::clip_length, 0.5, 50, "of a closed clip, default {}"),
      R::integer("clips", &I::clips, 0, 1000, "in the magazine, default {}"),
      R::object("electrode", electrode, &I::electrode, "of a hook or bipolar forceps").only([](const I& i) {
        return i.can().coagulate;
      }),
      R::object("needle", needle, &I::needle, "of an injection needle").only([](const I& i) { return i.can().inject; }),
      mechanism_row<I>("mechanism", &I::linkage,
                       "a mechanism, by its name in a library or its file from this one on: jaws go as its linkage "
                       "says, and open as far; "
                       "default: as the handle"),
      R::text("handle", &I::handle, "the mechanism's actuator that is the handle, default {}").only([](const I& i) {
        return !i.linkage.file.empty();
      }),
      R::object("wrist", wrist, &I::wrist, "default: it is rigid").only([](const I& i) { return i.wrist.there; })};
}

void check_instrument(const JsonObject& o, Instrument& i, Context&) {
  using interactions::Abilities;
  if (i.parallel_gap > 0 && !o.has("opening_deg")) i.opening = 0;
  const std::string kind = o.text("kind");
  if (o.has("electrode") && o.has("kind") && !i.can().coagulate)
    o.fault("electrode",
            tr("expected an electrode only in a {}, got one in a {}", kinds_that(&Abilities::coagulate), kind));
  if (o.has("needle") && o.has("kind") && !i.can().inject)
    o.fault("needle", tr("expected a needle only in a {}, got one in a {}", kinds_that(&Abilities::inject), kind));
  if (i.parallel_gap > 0 && i.opening > 0)
    o.fault("opening_deg", "expected 0 or nothing beside parallel_gap_mm (jaws turn or stay parallel), got an angle");
  if (o.has("mechanism") && o.has("opening_deg"))
    o.fault("opening_deg", "expected no angle beside mechanism, which defines the opening of the jaws, got one");
  if (o.has("handle") && !o.has("mechanism")) o.fault("handle", "expected a mechanism that it moves, got none");
  if (i.wrist.there && i.foot > 0) o.fault("wrist", "expected a rigid instrument with a foot, got one that bends");
  if (i.foot > 0 && o.has("kind") && !i.can().hook)
    o.fault("foot_mm", tr("expected a foot only in a {}, got one in a {}", kinds_that(&Abilities::hook), kind));
  if (i.foot > 0 && i.foot <= 0.5 * i.jaw_thickness)
    o.fault("foot_mm", "expected 0 or more than half of jaw_thickness_mm (the wire's radius), got no more than that");
  if (i.clips > 0 && o.has("kind") && !i.can().set_clips)
    o.fault("clips",
            tr("expected clips only in a {}, got {} in a {}", kinds_that(&Abilities::set_clips), i.clips, kind));
}

}  // namespace

namespace {

/// The mechanisms that can be called by their names: file by name, of two with one name the first folder's.
std::map<std::string, fs::path> shelf(const std::optional<Library>& library, const MemoryFiles* memory) {
  std::map<std::string, fs::path> out;
  const auto take = [&](const fs::path& path) {
    if (path.extension() == ".json" && path.parent_path().filename() == "mechanisms")
      out.emplace(path.stem().string(), path);
  };
  if (memory)
    for (const auto& [path, text] : *memory) take(path);
  std::error_code error;
  if (library)
    for (const fs::path& folder : library->folders("mechanisms"))
      for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) take(entry.path());
  return out;
}

}  // namespace

std::optional<fs::path> Reading::called(const JsonObject& o, const char* key) {
  const std::map<std::string, fs::path> known = shelf(m_library, m_memory);
  const auto found = known.find(o.text(key));
  if (found != known.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, path] : known) names.push_back(name);
  o.fault(key, unknown_name("mechanism", o.text(key), names));
  return {};
}

void Reading::mechanism_of(const JsonObject& o, const char* key, const fs::path& folder, NamedMechanism& mechanism) {
  mechanism.at = o.at(key);
  const bool by_name = !mechanism.file.empty() && mechanism.file.find_first_of("/.") == std::string::npos;
  const std::optional<fs::path> path =
      by_name ? called(o, key) : std::optional((folder / mechanism.file).lexically_normal());
  if (!path) return;
  const std::optional<std::string> text = by_name ? bytes_at(o, *path, key) : bytes_of(o, folder, key);
  if (!text) return;
  const std::size_t before = m_faults.size();
  kinematics::MechanismDescription read = parse_mechanism(*text, path->generic_string(), m_faults);
  if (m_faults.size() == before)
    mechanism.description = std::make_shared<const kinematics::MechanismDescription>(std::move(read));
}

const Table<Instrument>& instrument() {
  static const Table<Instrument> table{"instrument", "An instrument's shape and grip.", instrument_rows(),
                                       check_instrument};
  return table;
}
const Table<Instrument>& instrument_file_keys() {
  static const Table<Instrument> table{"instrument file", "An instrument's shape and grip.", of_file(instrument_rows()),
                                       check_instrument};
  return table;
}

}  // namespace trocar::scene
