#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/scene/json/json_text.hpp>

namespace trocar::scene {
namespace {

using Kind = JsonValue::Kind;
constexpr std::size_t kWidth = 118;

JsonValue of_kind(Kind kind) {
  JsonValue v;
  v.kind = kind;
  return v;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (static_cast<unsigned char>(c) < 0x20) {
      out += fmt::format("\\u{:04x}", int(c));
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string number(double value) {
  if (value == 0) return "0";  // also -0
  const bool whole = std::fabs(value) < 1e15 && value == std::floor(value);
  return whole ? fmt::format("{}", static_cast<long long>(value)) : fmt::format("{}", value);
}

/// All on one line; gives up (empty) where it gets longer than `room`.
bool on_a_line(const JsonValue& v, std::size_t room, std::string& out) {
  switch (v.kind) {
    case Kind::null:
    case Kind::broken:
      out += "null";
      break;
    case Kind::boolean:
      out += v.truth ? "true" : "false";
      break;
    case Kind::number:
      out += number(v.number);
      break;
    case Kind::string:
      out += quoted(v.text);
      break;
    case Kind::array: {
      out += '[';
      for (std::size_t i = 0; i < v.items.size(); ++i) {
        if (i > 0) out += ", ";
        if (!on_a_line(v.items[i], room, out)) return false;
      }
      out += ']';
      break;
    }
    case Kind::object: {
      out += '{';
      for (std::size_t i = 0; i < v.members.size(); ++i) {
        if (i > 0) out += ", ";
        out += quoted(v.members[i].key) + ": ";
        if (!on_a_line(v.members[i].value, room, out)) return false;
      }
      out += '}';
      break;
    }
  }
  return out.size() <= room;
}

bool is_point_or_number(const JsonValue& v) {
  if (v.kind == Kind::number) return true;
  return v.kind == Kind::array && v.items.size() <= 3 &&
         std::all_of(v.items.begin(), v.items.end(), [](const JsonValue& i) { return i.kind == Kind::number; });
}

void lay_out(const JsonValue& v, std::size_t indent, std::size_t used, std::string& out);

void filled_lines(const std::vector<JsonValue>& items, std::size_t indent, std::string& out) {
  const std::string pad(indent + 2, ' ');
  std::string line = pad;
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::string item;
    on_a_line(items[i], kWidth, item);
    if (i + 1 < items.size()) item += ',';
    if (line.size() > pad.size() && line.size() + 1 + item.size() > kWidth) {
      out += line + '\n';
      line = pad;
    }
    line += (line.size() > pad.size() ? " " : "") + item;
  }
  out += line + '\n';
}

void lay_out(const JsonValue& v, std::size_t indent, std::size_t used, std::string& out) {
  std::string line;
  const bool fits = on_a_line(v, kWidth > used ? kWidth - used : 0, line);
  const bool container = v.kind == Kind::array || v.kind == Kind::object;
  if (fits || !container || (v.items.empty() && v.members.empty())) {
    out += line;
    return;
  }
  const std::string pad(indent + 2, ' ');
  const bool array = v.kind == Kind::array;
  out += array ? "[\n" : "{\n";
  if (array && std::all_of(v.items.begin(), v.items.end(), is_point_or_number)) {
    filled_lines(v.items, indent, out);
  } else {
    const std::size_t count = array ? v.items.size() : v.members.size();
    for (std::size_t i = 0; i < count; ++i) {
      const std::string key = array ? std::string() : quoted(v.members[i].key) + ": ";
      out += pad + key;
      lay_out(array ? v.items[i] : v.members[i].value, indent + 2, pad.size() + key.size() + 1, out);
      out += i + 1 < count ? ",\n" : "\n";
    }
  }
  out += std::string(indent, ' ') + (array ? ']' : '}');
}

}  // namespace

JsonValue json_object() { return of_kind(Kind::object); }
JsonValue json_array(std::vector<JsonValue> items) {
  JsonValue v = of_kind(Kind::array);
  v.items = std::move(items);
  return v;
}
JsonValue json_number(double value) {
  JsonValue v = of_kind(Kind::number);
  v.number = value;
  return v;
}
JsonValue json_flag(bool value) {
  JsonValue v = of_kind(Kind::boolean);
  v.truth = value;
  return v;
}
JsonValue json_text(std::string value) {
  JsonValue v = of_kind(Kind::string);
  v.text = std::move(value);
  return v;
}
void put(JsonValue& object, std::string key, JsonValue value) {
  object.members.push_back({std::move(key), 0, 0, std::move(value), 0});
}

std::string to_text(const JsonValue& value) {
  std::string out;
  lay_out(value, 0, 0, out);
  return out + '\n';
}

}  // namespace trocar::scene
