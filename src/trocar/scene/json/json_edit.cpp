#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/json_text.hpp>

namespace trocar::scene {
namespace {

using Kind = JsonValue::Kind;

[[noreturn]] void refuse(std::string_view path, const char* why) {
  throw std::invalid_argument(tr("expected {}, got the path \"{}\"", why, path));
}

/// The last step of a path, its escapes resolved, and what is above it.
std::pair<std::string_view, std::string> parent_and_step(std::string_view path) {
  const std::size_t slash = path.rfind('/');
  if (slash == path.npos) refuse(path, "a path below the root");
  std::string step;
  for (std::size_t i = slash + 1; i < path.size(); ++i) {
    const bool escape = path[i] == '~' && i + 1 < path.size();
    step += escape ? (path[++i] == '1' ? '/' : '~') : path[i];
  }
  return {path.substr(0, slash), step};
}

/// None: the step is no number of an item.
std::size_t item_of(const std::string& step) {
  const bool digits = !step.empty() && step.size() < 8 &&
                      std::all_of(step.begin(), step.end(), [](char c) { return c >= '0' && c <= '9'; });
  return digits ? std::size_t(std::stoul(step)) : std::string::npos;
}

JsonDocument parsed(std::string_view text) {
  std::vector<core::Fault> faults;
  JsonDocument document = parse_json(text, "text", faults);
  if (!faults.empty()) throw std::invalid_argument(core::to_string(faults.front()));
  return document;
}

/// Spaces with which the line of this byte begins.
std::string indent_at(std::string_view text, std::size_t at) {
  const std::size_t line = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;  // npos + 1 is 0
  std::size_t end = line;
  while (end < text.size() && text[end] == ' ') ++end;
  return std::string(text.substr(line, end - line));
}

/// As it is written where the line is indented like that.
std::string written(const JsonValue& value, const std::string& indent) {
  std::string text = to_text(value);
  text.pop_back();
  for (std::size_t at = text.find('\n'); at != text.npos; at = text.find('\n', at + 1 + indent.size()))
    text.insert(at + 1, indent);
  return text;
}

struct Part {
  std::size_t from, to;
};

/// Members or items of a container, as bytes.
std::vector<Part> parts_of(const JsonValue& container) {
  std::vector<Part> parts;
  for (const JsonMember& m : container.members) parts.push_back({m.from, m.value.to});
  for (const JsonValue& v : container.items) parts.push_back({v.from, v.to});
  return parts;
}

/// The first byte from `at` on that is neither space nor comment.
std::size_t after_space(std::string_view text, std::size_t at) {
  while (at < text.size()) {
    if (text.substr(at, 2) == "//")
      at = std::min(text.find('\n', at), text.size());
    else if (text.substr(at, 2) == "/*")
      at = std::min(text.find("*/", at), text.size() - 2) + 2;
    else if (text[at] == ' ' || text[at] == '\t' || text[at] == '\r' || text[at] == '\n')
      ++at;
    else
      break;
  }
  return at;
}

bool breaks_lines(std::string_view text, Part part) {
  return text.substr(part.from, part.to - part.from).find('\n') != std::string_view::npos;
}

/// Is a part the first thing on its line?
bool begins_line(std::string_view text, std::size_t at) {
  while (at > 0 && text[at - 1] == ' ') --at;
  return at == 0 || text[at - 1] == '\n';
}

/// Where a line ends that holds nothing more than spaces, a comma and a comment.
std::size_t end_of_line_comment(std::string_view text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && text[end] == ' ') ++end;
  if (text.substr(end, 2) == "//") return std::min(text.find('\n', end), text.size());
  return end < text.size() && text[end] == '\n' ? end : at;
}

std::string put_into_empty(std::string text, const JsonValue& container, const std::string& key, const JsonValue& v) {
  const std::string inner = indent_at(text, container.from) + "  ";
  const std::size_t end = container.to - 1;
  std::string part = key + written(v, inner);
  const bool lines = breaks_lines(text, {container.from, container.to}) || part.find('\n') != part.npos;
  if (lines) {  // whatever comment stands in it stays
    std::size_t at = end;
    while (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '\n')) --at;
    return text.replace(at, end - at, "\n" + inner + part + "\n" + indent_at(text, container.from));
  }
  return text.insert(end, part);
}

/// Puts `key` and the value in front of part `where` of the container, or behind its last one.
std::string put_part(std::string text, const JsonValue& container, std::size_t where, const std::string& key,
                     const JsonValue& v) {
  const std::vector<Part> parts = parts_of(container);
  if (parts.empty()) return put_into_empty(std::move(text), container, key, v);
  if (where < parts.size()) {
    const std::size_t at = parts[where].from;
    const bool own_line = begins_line(text, at);
    const std::string indent = indent_at(text, at);
    const std::string between = own_line ? ",\n" + indent : ", ";
    return text.insert(at, key + written(v, indent) + between);
  }
  const Part last = parts.back();
  const bool own_line =
      begins_line(text, last.from) && (parts.size() > 1 ? begins_line(text, parts[parts.size() - 2].from) : true);
  const std::string indent = own_line ? indent_at(text, last.from) : indent_at(text, container.from) + "  ";
  const std::string part = key + written(v, indent);
  if (!own_line && part.find('\n') == part.npos) return text.insert(last.to, ", " + part);
  const std::size_t end = end_of_line_comment(text, last.to);
  text.insert(end, "\n" + indent + part);
  return text.insert(last.to, ",");
}

}  // namespace

std::string json_path(std::string_view path, std::string_view key) {
  std::string out(path);
  out += '/';
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}
std::string json_path(std::string_view path, std::size_t item) { return fmt::format("{}/{}", path, item); }

const JsonValue* json_at(const JsonValue& root, std::string_view path) {
  if (path.empty()) return &root;
  const auto [parent, step] = parent_and_step(path);
  const JsonValue* above = json_at(root, parent);
  if (!above) return nullptr;
  if (above->kind == Kind::object) {
    const JsonMember* member = above->find(step);
    return member ? &member->value : nullptr;
  }
  const std::size_t item = item_of(step);
  return above->kind == Kind::array && item < above->items.size() ? &above->items[item] : nullptr;
}

bool same_json(const JsonValue& a, const JsonValue& b) {
  if (a.kind != b.kind || a.truth != b.truth || a.number != b.number || a.text != b.text) return false;
  return std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(), same_json) &&
         std::equal(
             a.members.begin(), a.members.end(), b.members.begin(), b.members.end(),
             [](const JsonMember& m, const JsonMember& n) { return m.key == n.key && same_json(m.value, n.value); });
}

std::string json_set(std::string_view text, std::string_view path, const JsonValue& value) {
  const JsonDocument document = parsed(text);
  std::string out(text);
  if (const JsonValue* there = json_at(document.root, path)) {
    if (same_json(*there, value)) return out;
    return out.replace(there->from, there->to - there->from, written(value, indent_at(text, there->from)));
  }
  const auto [parent, step] = parent_and_step(path);
  const JsonValue* above = json_at(document.root, parent);
  if (above && above->kind == Kind::object)
    return put_part(std::move(out), *above, above->members.size(), written(json_text(step), "") + ": ", value);
  if (!above || above->kind != Kind::array || item_of(step) != above->items.size())
    refuse(path, "a key of an object, or an item of an array or the next one");
  return put_part(std::move(out), *above, above->items.size(), "", value);
}

std::string json_set_all(std::string_view text, std::vector<std::pair<std::string, JsonValue>> values) {
  const JsonDocument document = parsed(text);
  std::vector<std::pair<const JsonValue*, const JsonValue*>> changes;
  for (const auto& [path, value] : values) {
    const JsonValue* there = json_at(document.root, path);
    if (!there) refuse(path, "a value that is there");
    if (!same_json(*there, value)) changes.emplace_back(there, &value);
  }
  std::sort(changes.begin(), changes.end(), [](const auto& a, const auto& b) { return a.first->from > b.first->from; });
  std::string out(text);
  for (const auto& [there, value] : changes)
    out.replace(there->from, there->to - there->from, written(*value, indent_at(text, there->from)));
  return out;
}

std::string json_insert(std::string_view text, std::string_view array, std::size_t item, const JsonValue& value) {
  const JsonDocument document = parsed(text);
  const JsonValue* there = json_at(document.root, array);
  if (!there || there->kind != Kind::array || item > there->items.size()) refuse(array, "an array with this item");
  return put_part(std::string(text), *there, item, "", value);
}

namespace {

/// What stands before spaces and line breaks.
std::size_t back_over_space(std::string_view text, std::size_t at) {
  while (at > 0 && (text[at - 1] == ' ' || text[at - 1] == '\n')) --at;
  return at;
}

/// Does a comment that goes to the end of its line stand at `at`? From `begin` on there is nothing but space and
/// comments.
bool in_line_comment(std::string_view text, std::size_t begin, std::size_t at) {
  const std::string_view gap = text.substr(begin, at - begin);
  const std::size_t line = gap.rfind('\n');
  return gap.find("//", line == gap.npos ? 0 : line) != gap.npos;
}

}  // namespace

std::string json_remove(std::string_view text, std::string_view path) {
  const JsonDocument document = parsed(text);
  const JsonValue* there = json_at(document.root, path);
  if (!there) refuse(path, "a value that is there");
  const auto [parent, step] = parent_and_step(path);
  const JsonValue& above = *json_at(document.root, parent);
  const std::vector<Part> parts = parts_of(above);
  std::size_t which = 0;
  while (parts[which].to != there->to) ++which;
  std::string out(text);
  std::size_t from = parts[which].from, to = parts[which].to;
  if (which + 1 < parts.size()) {  // with the comma behind it, up to what comes next
    const std::size_t comma = after_space(text, to);
    const std::size_t end = end_of_line_comment(text, comma + 1);
    if (begins_line(text, from) && end < text.size() && text[end] == '\n') {
      from -= indent_at(text, from).size();
      return out.erase(from, end + 1 - from);
    }
    to = comma + 1;
    while (to < text.size() && text[to] == ' ') ++to;
    return out.erase(from, to - from);
  }
  to = end_of_line_comment(text, to);
  if (which == 0) {
    from = back_over_space(text, from);
    const std::size_t end = after_space(text, to);
    return out.replace(from, end - from, in_line_comment(text, above.from + 1, from) ? "\n" : "");
  }
  const std::size_t comma = after_space(text, parts[which - 1].to);
  // the comment between the one before and this one stays with the one before
  const std::size_t begin = std::max(comma + 1, back_over_space(text, from));
  const bool needs_line = in_line_comment(text, comma + 1, begin) && to < text.size() && text[to] != '\n';
  out.replace(begin, to - begin, needs_line ? "\n" : "");
  return out.erase(comma, 1);
}

}  // namespace trocar::scene
