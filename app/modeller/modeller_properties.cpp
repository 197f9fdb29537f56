// What the chosen thing is: every key of its table, as its file says it, with what it means; and what it comes to.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/document/plain_words.hpp>
#include <trocar/modeller/drive/body_memory.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/json_text.hpp>
#include <trocar/sim/model/bodies.hpp>

#include "modeller/chooser.hpp"
#include "modeller/modeller_parts.hpp"

namespace trocar::app {
namespace {

using scene::JsonValue;
using Type = scene::Key::Type;

/// The table of a kind of thing; null: it has none here.
const scene::Shape* shape_of(const modeller::Thing& thing) {
  for (const modeller::KindOfThing& kind : modeller::kinds_of_things()) {
    if (thing.kind != kind.kind) continue;
    const scene::Shape& in = kind.in_organs ? scene::organ_shape() : scene::scene_shape();
    const scene::Key* list = in.find(kind.list);
    return list && list->shape && list->type != Type::includes ? &list->shape() : nullptr;
  }
  return nullptr;
}

void meaning_of(const scene::Key& key) {
  if (!ImGui::IsItemHovered()) return;
  const std::string text = ui::wrapped(tr(key.meaning.c_str()), 320 * ui::scale());
  ImGui::SetTooltip("%s", text.c_str());
}

}  // namespace

/// A field for a simple value. What comes back is another value that somebody has finished with.
std::optional<JsonValue> Modeller::edited(const scene::Key& key, const JsonValue* value, const std::string& id) {
  if (key.type == Type::flag) {
    const char* words[] = {tr("automatic"), tr("yes"), tr("no")};
    int which = value ? (value->truth ? 1 : 2) : 0;
    if (ImGui::Combo(id.c_str(), &which, words, 3) && which > 0) return scene::json_flag(which == 1);
    return std::nullopt;
  }
  const std::vector<std::string>& choices = key.choices;
  if (key.name == "look") {
    std::string material = value ? value->text : "";
    return draw_material_list(id, material) ? std::optional(scene::json_text(material)) : std::nullopt;
  }
  if (!choices.empty()) {
    std::optional<JsonValue> chosen;
    if (ImGui::BeginCombo(id.c_str(), value ? value->text.c_str() : tr("automatic"))) {
      for (const std::string& choice : choices)
        if (ImGui::Selectable(choice.c_str(), value && value->text == choice)) chosen = scene::json_text(choice);
      ImGui::EndCombo();
    }
    return chosen;
  }
  const bool vector = key.type == Type::vec3, number = key.type == Type::number || key.type == Type::integer;
  if (value && (number || (vector && modeller::is_point(*value)))) {
    std::array<double, 3>& field = m_numbers[id];
    const double range = std::max(1e-3, std::min(key.high - key.low, 200.0)), step = number ? range / 400 : 0.25;
    if (!ImGui::IsAnyItemActive()) {
      field[0] = number ? value->number : value->items[0].number;
      for (std::size_t i = 1; vector && i < 3; ++i) field[i] = value->items[i].number;
    }
    if (number)
      ImGui::DragScalar(id.c_str(), ImGuiDataType_Double, field.data(), float(step), &key.low, &key.high, "%.6g");
    else
      ImGui::DragScalarN(id.c_str(), ImGuiDataType_Double, field.data(), 3, float(step), &key.low, &key.high, "%.5g");
    if (!ImGui::IsItemDeactivatedAfterEdit()) return std::nullopt;
    if (vector) return modeller::point({field[0], field[1], field[2]});
    return modeller::number(key.type == Type::integer ? std::round(field[0]) : field[0]);
  }
  std::string& text = m_texts[id];
  if (!ImGui::IsAnyItemActive()) text = value && value->kind == JsonValue::Kind::string ? value->text : "";
  char typed[512];
  std::snprintf(typed, sizeof typed, "%s", text.c_str());
  if (ImGui::InputTextWithHint(id.c_str(), tr("automatic"), typed, sizeof typed)) text = typed;
  if (!ImGui::IsItemDeactivatedAfterEdit() || text.empty()) return std::nullopt;
  if (key.type == Type::text || key.type == Type::name) return scene::json_text(text);
  std::vector<core::Fault> faults;
  const bool bare = vector && text.find('[') == std::string::npos;
  scene::JsonDocument read = scene::parse_json(bare ? "[" + text + "]" : text, "here", faults);
  if (faults.empty()) return std::move(read.root);
  warn(faults.front().message);
  return std::nullopt;
}

void Modeller::draw_key(const scene::Key& key, const JsonValue* value, const std::string& path, int depth) {
  const std::string at = path.empty() ? key.name : path + "/" + key.name;
  const bool nested = key.type == Type::object || key.type == Type::objects;
  if (nested && value && key.shape && depth < 3) {
    const std::size_t count = value->items.size();
    const bool list = key.type == Type::objects;
    const std::string label = list ? fmt::format("{} ({})###{}", modeller::label_of_key(key.name), count, at)
                                   : modeller::label_of_key(key.name) + "###" + at;
    const bool open = ImGui::TreeNode(label.c_str());
    meaning_of(key);
    ui::note_widget("key " + at);
    if (!open) return;
    if (!list) draw_keys(key.shape(), *value, at, depth + 1);
    for (std::size_t i = 0; list && i < count; ++i) {
      const bool taken = m_handle && m_handle->list == "/" + at && m_handle->item == i;
      if (taken) ImGui::SetNextItemOpen(true, ImGuiCond_Always);
      if (!ImGui::TreeNode(fmt::format("{}###{}/{}", i + 1, at, i).c_str())) continue;
      draw_keys(key.shape(), value->items[i], fmt::format("{}/{}", at, i), depth + 1);
      ImGui::TreePop();
    }
    ImGui::TreePop();
    return;
  }
  const bool simple = key.type == Type::number || key.type == Type::integer || key.type == Type::flag ||
                      key.type == Type::text || key.type == Type::name || key.type == Type::vec3;
  if (!simple && !value) return;
  ui::text(modeller::label_of_key(key.name), value ? ui::kWhite : ui::kGrey);
  meaning_of(key);
  ImGui::SameLine(std::max(172.0f - 12.0f * float(depth), 110.0f) * ui::scale());
  if (!simple) {
    std::string text;
    for (const JsonValue& item : value->items)
      if (item.kind == JsonValue::Kind::string) text += (text.empty() ? "" : ", ") + item.text;
    ui::text(text.empty() ? tr("{} points", value->items.size()) : text, ui::kGrey);
    return;
  }
  ImGui::SetNextItemWidth(-1);
  if (key.name == "tissue" && path.empty()) {
    choose_tissue_of_selected(value);
    return;
  }
  const std::optional<JsonValue> wanted = edited(key, value, "##" + at);
  ui::note_widget("key " + at);
  meaning_of(key);
  if (wanted && set_key(at, *wanted)) tell(tr("Set: {}", modeller::label_of_key(key.name)));
}

/// First what the file says, then what it leaves to defaults.
void Modeller::draw_keys(const scene::Shape& shape, const JsonValue& value, const std::string& path, int depth) {
  bool more = false;
  for (const scene::Key& key : shape.keys) {
    const scene::JsonMember* there = value.find(key.name);
    if (there)
      draw_key(key, &there->value, path, depth);
    else
      more = true;
  }
  if (!more || !ImGui::TreeNode(fmt::format("{}###{}/defaults", tr("Advanced"), path).c_str())) return;
  for (const scene::Key& key : shape.keys)
    if (!value.find(key.name)) draw_key(key, nullptr, path, depth);
  ImGui::TreePop();
}

const std::vector<modeller::TissueChoice>& Modeller::tissues() {
  if (m_document && m_tissues_of != m_document->version()) {
    m_tissues = modeller::tissue_choices(*m_document);
    m_tissues_of = m_document->version();
  }
  return m_tissues;
}

/// Another tissue, and the material that fits it unless one was chosen.
bool Modeller::choose_tissue(const std::string& thing, std::string name) {
  const auto set = [&](const char* key, const std::string& text) {
    JsonValue s = scene::json_object();
    scene::put(s, "do", scene::json_text("set"));
    scene::put(s, "of", scene::json_text(thing));
    scene::put(s, "key", scene::json_text(key));
    scene::put(s, "value", scene::json_text(text));
    return step(std::move(s));
  };
  const JsonValue before = modeller::value_of(*m_document, modeller::thing_named(*m_document, thing));
  const scene::JsonMember *look = before.find("look"), *old = before.find("tissue");
  const bool fitted = !look || (old && look->value.text == modeller::material_of_tissue(old->value.text));
  if (!set("tissue", name)) return false;
  if (const std::string material = modeller::material_of_tissue(name); fitted && !material.empty())
    if (!set("look", material)) return false;
  tell(tr("Tissue: {}", name));
  return true;
}

void Modeller::choose_tissue_of_selected(const JsonValue* value) {
  std::string name = value ? value->text : "";
  const bool changed = draw_tissue_list("##key tissue", tissues(), name);
  ui::note_widget("key tissue");
  if (changed) choose_tissue(m_selected, name);
}

namespace {

/// Share of real time, in words and a colour that says whether it is good.
void draw_load(double us, bool of_all) {
  constexpr double kGood = 400, kBad = 1000;  // [us] of the 1000 that a step may take
  ui::mark(us < kGood ? ui::Mark::done : us < kBad ? ui::Mark::warning : ui::Mark::error);
  const std::string load = us >= kBad ? tr("Load: {:.0f} % of real time: slow motion", 0.1 * us)
                           : of_all   ? tr("Load: {:.0f} % of real time (without contacts)", 0.1 * us)
                                      : tr("Load: {:.0f} % of real time", 0.1 * us);
  ui::text(load, us < kGood ? ui::kWhite : us < kBad ? ui::kOrange : ui::kRed);
}

}  // namespace

void Modeller::draw_size_and_load(const modeller::ReadOut& r) {
  ui::heading(tr("Size and load"));
  if (r.volume_mL > 0) ui::text(tr("Volume {:.1f} mL, mass {:.1f} g", r.volume_mL, r.mass_g));
  Vec3d low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const modeller::BodyPlace& p : m_places)
    if (sim::name_of(*m_shown->built.model, p.body) == r.name)
      for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], p.at[k]), high[k] = std::max(high[k], p.at[k]);
  if (high.x > low.x)
    ui::text(
        tr("Size {:.0f} x {:.0f} x {:.0f} mm", 1e3 * (high.x - low.x), 1e3 * (high.y - low.y), 1e3 * (high.z - low.z)));
  draw_load(r.predicted_us, false);
  if (r.off_mm >= 0) {
    ui::mark(r.off_mm > 0.5 ? ui::Mark::warning : ui::Mark::done);
    ui::text(r.off_mm > 0.5 ? tr("Sags by {:.1f} mm in 0.5 s. Attach more of it, or choose a firmer tissue.", r.off_mm)
                            : std::string(tr("In equilibrium")),
             r.off_mm > 0.5 ? ui::kOrange : ui::kWhite);
  }
  if (!ImGui::TreeNode(tr("Details"))) return;
  ui::text(r.substeps > 0
               ? tr("{} nodes, {} springs, {} sub-steps of {:.3f} ms", r.nodes, r.springs, r.substeps, 1.0 / r.substeps)
               : tr("{} nodes, {} springs, implicit solver", r.nodes, r.springs),
           ui::kGrey);
  if (r.limit_ms > 0) ui::text(tr("Stable up to steps of {:.3f} ms", r.limit_ms), ui::kGrey);
  ui::text(tr("{} of memory", modeller::memory_in_words(r.bytes)), ui::kGrey);
  ImGui::TreePop();
}

void Modeller::draw_read_outs(const modeller::Thing& thing) {
  if (!m_shown) return;
  for (const modeller::ReadOut& r : m_shown->read_outs)
    if (r.name == thing.name) draw_size_and_load(r);
}

/// Stress over strain as the file's law has it.  [KCM99 eq.5]
void Modeller::draw_tissue(const std::string& name) {
  for (const modeller::Thing& t : m_things) {
    if (t.kind != "tissue" || t.name != name) continue;
    const JsonValue v = modeller::value_of(*m_document, t);
    const double young = modeller::number_in(v, "young_Pa", 0), p1 = modeller::number_in(v, "p1", 0),
                 p2 = modeller::number_in(v, "p2", 0), cap = modeller::number_in(v, "strain_cap", 0.2);
    const auto stress = [&](double e) {
      const double c = std::min(e, cap), at_cap = young * c * (1 + p1 * c + p2 * c * c);
      return at_cap + (e - c) * young * (1 + 2 * p1 * c + 3 * p2 * c * c);
    };
    std::array<float, 60> curve{};
    const double most = 1.5 * cap;
    for (std::size_t i = 0; i < curve.size(); ++i)
      curve[i] = float(1e-3 * stress(most * double(i) / double(curve.size() - 1)));
    ui::heading(tr("Stress over strain"));
    const std::string label = tr("{:.0f} kPa at {:.0f} %", curve.back(), 100 * most);
    ImGui::PushStyleColor(ImGuiCol_PlotLines, ui::kBlue);
    ImGui::PlotLines("##law", curve.data(), int(curve.size()), 0, label.c_str(), 0, curve.back(),
                     ImVec2(ImGui::GetContentRegionAvail().x, 90 * ui::scale()));
    ImGui::PopStyleColor();
    ui::text(tr("{}: Young's modulus {:.3g} kPa, linear beyond {:.0f} % strain", modeller::stiffness_in_words(young),
                young * 1e-3, 100 * cap),
             ui::kGrey);
    if (const scene::JsonMember* source = v.find("source")) ui::text(source->value.text, ui::kGrey);
    return;
  }
}

void Modeller::draw_properties() {
  ImGui::SetNextWindowPos({m_right.x, m_right.y});
  ImGui::SetNextWindowSize({m_right.width, m_right.height});
  ImGui::Begin("properties", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoBringToFrontOnFocus);
  const std::optional<modeller::Thing> thing = selected();
  if (thing) {
    ui::title(thing->name);
    ui::text(modeller::label_of_kind(thing->kind), ui::kGrey);
    draw_thing(*thing);
  } else {
    draw_overview();
  }
  ImGui::End();
}

void Modeller::draw_overview() {
  ui::title(tr("The scene"));
  if (m_shown) {
    double us = 0, grams = 0;
    int nodes = 0;
    for (const modeller::ReadOut& r : m_shown->read_outs) us += r.predicted_us, grams += r.mass_g, nodes += r.nodes;
    ui::text(tr("Bodies: {}, {:.0f} g together", m_shown->read_outs.size(), grams));
    draw_load(us, true);
    if (ImGui::TreeNode(tr("Details"))) {
      ui::text(tr("{} nodes, compiled in {:.1f} s", nodes, m_shown->built.seconds), ui::kGrey);
      ImGui::TreePop();
    }
  }
  ui::text(tr("Click a body, or choose one on the left."), ui::kGrey);
}

void Modeller::draw_thing(const modeller::Thing& thing) {
  const JsonValue value = modeller::value_of(*m_document, thing);
  draw_read_outs(thing);
  if (value.find("tissue")) ui::heading(tr("Properties"));
  if (const scene::Shape* shape = shape_of(thing)) {
    draw_keys(*shape, value, "", 0);
  } else {
    for (const scene::JsonMember& m : value.members) {
      const bool number = m.value.kind == JsonValue::Kind::number, text = m.value.kind == JsonValue::Kind::string;
      const std::string label = modeller::label_of_key(m.key);
      ui::text(number ? fmt::format("{}: {:g}", label, m.value.number)
               : text ? fmt::format("{}: {}", label, m.value.text)
                      : tr("{}: {} items", label, m.value.items.size()));
    }
  }
  if (const scene::JsonMember* tissue = value.find("tissue")) draw_tissue(tissue->value.text);
}

}  // namespace trocar::app
