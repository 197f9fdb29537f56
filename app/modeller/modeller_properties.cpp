// What the chosen thing is: every key of its table, as its file says it, with what it means; and what it comes to.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

#include <trocar/modeller/drive/body_memory.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/json_text.hpp>

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
  const std::string text = ui::wrapped(key.meaning, 320 * ui::scale());
  ImGui::SetTooltip("%s", text.c_str());
}

}  // namespace

/// A field for a simple value. What comes back is another value that somebody has finished with.
std::optional<JsonValue> Modeller::edited(const scene::Key& key, const JsonValue* value, const std::string& id) {
  if (key.type == Type::flag) {
    const char* words[] = {"default", "yes", "no"};
    int which = value ? (value->truth ? 1 : 2) : 0;
    if (ImGui::Combo(id.c_str(), &which, words, 3) && which > 0) return scene::json_flag(which == 1);
    return std::nullopt;
  }
  std::vector<std::string> choices = key.choices;
  if (key.name == "tissue")
    for (const modeller::Thing& t : m_things)
      if (t.kind == "tissue") choices.push_back(t.name);
  if (!choices.empty()) {
    std::optional<JsonValue> chosen;
    if (ImGui::BeginCombo(id.c_str(), value ? value->text.c_str() : "default")) {
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
  if (ImGui::InputTextWithHint(id.c_str(), "default", typed, sizeof typed)) text = typed;
  if (!ImGui::IsItemDeactivatedAfterEdit() || text.empty()) return std::nullopt;
  if (key.type == Type::text || key.type == Type::name) return scene::json_text(text);
  std::vector<core::Fault> faults;
  const bool bare = vector && text.find('[') == std::string::npos;
  scene::JsonDocument read = scene::parse_json(bare ? "[" + text + "]" : text, "here", faults);
  if (faults.empty()) return std::move(read.root);
  tell(faults.front().message);
  return std::nullopt;
}

void Modeller::draw_key(const scene::Key& key, const JsonValue* value, const std::string& path, int depth) {
  const std::string at = path.empty() ? key.name : path + "/" + key.name;
  const bool nested = key.type == Type::object || key.type == Type::objects;
  if (nested && value && key.shape && depth < 3) {
    const std::size_t count = value->items.size();
    const bool list = key.type == Type::objects;
    const std::string label = list ? fmt::format("{} ({})###{}", key.name, count, at) : key.name + "###" + at;
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
  ui::text(key.name, value ? ui::kWhite : ui::kGrey);
  meaning_of(key);
  ImGui::SameLine(std::max(172.0f - 12.0f * float(depth), 110.0f) * ui::scale());
  if (!simple) {
    std::string text;
    for (const JsonValue& item : value->items)
      if (item.kind == JsonValue::Kind::string) text += (text.empty() ? "" : ", ") + item.text;
    ui::text(text.empty() ? fmt::format("{} points", value->items.size()) : text, ui::kGrey);
    return;
  }
  ImGui::SetNextItemWidth(-1);
  const std::optional<JsonValue> wanted = edited(key, value, "##" + at);
  ui::note_widget("key " + at);
  meaning_of(key);
  if (wanted && set_key(at, *wanted)) tell("set " + at);
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
  if (!more || !ImGui::TreeNode(("defaults###" + path + "/defaults").c_str())) return;
  for (const scene::Key& key : shape.keys)
    if (!value.find(key.name)) draw_key(key, nullptr, path, depth);
  ImGui::TreePop();
}

void Modeller::draw_read_outs(const modeller::Thing& thing) {
  if (!m_shown) return;
  for (const modeller::ReadOut& r : m_shown->read_outs) {
    if (r.name != thing.name) continue;
    ui::heading("what it comes to");
    if (r.volume_mL > 0) ui::text(fmt::format("{:.1f} mL, {:.1f} g", r.volume_mL, r.mass_g));
    ui::text(r.substeps > 0 ? fmt::format("{} nodes, {} springs, {} sub-steps of {:.3f} ms", r.nodes, r.springs,
                                          r.substeps, 1.0 / r.substeps)
                            : fmt::format("{} nodes, {} springs, solved implicitly", r.nodes, r.springs));
    if (r.limit_ms > 0) ui::text(fmt::format("stable up to {:.3f} ms", r.limit_ms), ui::kGrey);
    ui::text(modeller::memory_in_words(r.bytes) + " in memory", ui::kGrey);
    ui::text(fmt::format("about {:.0f} us of a tick's 1000", r.predicted_us),
             r.predicted_us > 600 ? ui::kOrange : ui::kWhite);
    if (r.off_mm < 0) continue;
    ui::mark(r.off_mm > 0.5 ? ui::Mark::warning : ui::Mark::done);
    ui::text(r.off_mm > 0.5 ? fmt::format("sinks by {:.1f} mm in half a second: hold it more, or stiffen it", r.off_mm)
                            : "hangs still",
             r.off_mm > 0.5 ? ui::kOrange : ui::kWhite);
  }
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
    ui::heading("stress over strain");
    const std::string label = fmt::format("{:.0f} kPa at {:.0f} %", curve.back(), 100 * most);
    ImGui::PushStyleColor(ImGuiCol_PlotLines, ui::kBlue);
    ImGui::PlotLines("##law", curve.data(), int(curve.size()), 0, label.c_str(), 0, curve.back(),
                     ImVec2(ImGui::GetContentRegionAvail().x, 90 * ui::scale()));
    ImGui::PopStyleColor();
    ui::text(fmt::format("E {:.3g} kPa, linear beyond {:.0f} %", young * 1e-3, 100 * cap), ui::kGrey);
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
    ui::text(fmt::format("{} in {}, line {}", thing->kind, thing->file.filename().string(), thing->line), ui::kGrey);
    draw_thing(*thing);
  } else {
    ui::title("All of it");
    if (m_shown) {
      double us = 0, grams = 0;
      int nodes = 0;
      for (const modeller::ReadOut& r : m_shown->read_outs) us += r.predicted_us, grams += r.mass_g, nodes += r.nodes;
      ui::text(fmt::format("{} bodies, {} nodes, {:.0f} g", m_shown->read_outs.size(), nodes, grams));
      ui::text(fmt::format("about {:.0f} us of a tick's 1000, contacts beside", us));
      ui::text(fmt::format("compiled in {:.1f} s", m_shown->built.seconds), ui::kGrey);
    }
    ui::text("Click on a body, or choose one on the left.", ui::kGrey);
  }
  ImGui::End();
}

void Modeller::draw_thing(const modeller::Thing& thing) {
  const JsonValue value = modeller::value_of(*m_document, thing);
  if (const scene::Shape* shape = shape_of(thing)) {
    draw_keys(*shape, value, "", 0);
  } else {
    for (const scene::JsonMember& m : value.members) {
      const bool number = m.value.kind == JsonValue::Kind::number, text = m.value.kind == JsonValue::Kind::string;
      ui::text(m.key + (number ? fmt::format(": {:g}", m.value.number)
                        : text ? ": " + m.value.text
                               : fmt::format(": {} items", m.value.items.size())));
    }
  }
  draw_read_outs(thing);
  if (const scene::JsonMember* tissue = value.find("tissue")) draw_tissue(tissue->value.text);
}

}  // namespace trocar::app
