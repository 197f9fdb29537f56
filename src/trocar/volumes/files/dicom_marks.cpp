#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/decimal.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/geometry/voxel_files/numbers.hpp>
#include <trocar/volumes/files/dicom_marks.hpp>

namespace trocar::volumes {
namespace {

/// How a value is written.
enum class Form : unsigned char { text, u16, u32, real32, real64, date_time };

/// Where a mark is looked for: an attribute of the data set (sequence 0), or of a sequence of a frame's groups.
struct Place {
  Mark mark;
  std::uint32_t sequence, tag;
  Form form;
};
constexpr std::uint32_t kFrameContent = 0x00209111, kMrEcho = 0x00189114, kDiffusion = 0x00189117,
                        kGradient = 0x00189076, kCardiac = 0x00189118, kMrType = 0x00189226, kCtType = 0x00189329,
                        kCtReconstruction = 0x00189314, kCtXray = 0x00189325;
constexpr Place kPlaces[] = {
    {Mark::temporal_position, kFrameContent, 0x00209128, Form::u32},
    {Mark::temporal_position, 0, 0x00200100, Form::text},
    {Mark::acquisition, kFrameContent, 0x00209156, Form::u16},
    {Mark::acquisition, 0, 0x00200012, Form::text},
    {Mark::echo, 0, 0x00180086, Form::text},
    {Mark::echo_time, kMrEcho, 0x00189082, Form::real64},
    {Mark::echo_time, 0, 0x00180081, Form::text},
    {Mark::inversion_time, 0, 0x00180082, Form::text},
    {Mark::trigger_time, kCardiac, 0x00209153, Form::real64},
    {Mark::trigger_time, 0, 0x00181060, Form::text},
    {Mark::cardiac_phase, kCardiac, 0x00209241, Form::real32},
    {Mark::cardiac_phase, 0, 0x00209241, Form::real32},
    {Mark::reference_time, 0, 0x00541300, Form::text},
    {Mark::b_value, kDiffusion, 0x00189087, Form::real64},
    {Mark::b_value, 0, 0x00189087, Form::real64},
    {Mark::gradient, kGradient, 0x00189089, Form::real64},
    {Mark::gradient, 0, 0x00189089, Form::real64},
    {Mark::image_type, kMrType, 0x00089007, Form::text},
    {Mark::image_type, kCtType, 0x00089007, Form::text},
    {Mark::image_type, 0, 0x00080008, Form::text},
    {Mark::component, kMrType, 0x00089208, Form::text},
    {Mark::component, 0, 0x00089208, Form::text},
    {Mark::kernel, kCtReconstruction, 0x00181210, Form::text},
    {Mark::kernel, 0, 0x00181210, Form::text},
    {Mark::voltage, kCtXray, 0x00180060, Form::text},
    {Mark::voltage, 0, 0x00180060, Form::text},
    {Mark::acquisition_time, kFrameContent, 0x00189074, Form::date_time},
    {Mark::acquisition_time, 0, 0x0008002a, Form::date_time},
    {Mark::instance, 0, 0x00200013, Form::text},
};

constexpr std::size_t kMostMark = 128;  // [bytes]; each of up to 65536 frames has marks of its own

/// "20261130", "100500.5" as "2026-11-30 10:05:00.500": later ones come later among texts, too.
std::string date_and_time(std::string date, std::string time) {
  const auto only_digits = [](std::string& text, const char* more) {
    text.erase(std::remove_if(text.begin(), text.end(),
                              [&](char c) { return !(c >= '0' && c <= '9') && (c == '\0' || !std::strchr(more, c)); }),
               text.end());
  };
  only_digits(date, "");
  only_digits(time, ".");
  if (time.empty()) return "";
  const std::size_t point = std::min(time.find('.'), time.size());
  std::string whole = time.substr(0, point), rest = time.substr(std::min(point + 1, time.size()));
  whole.resize(6, '0');
  rest.resize(3, '0');
  std::string out = whole.substr(0, 2) + ":" + whole.substr(2, 2) + ":" + whole.substr(4, 2) + "." + rest;
  if (date.size() == 8) out = date.substr(0, 4) + "-" + date.substr(4, 2) + "-" + date.substr(6, 2) + " " + out;
  return out;
}

std::string short_number(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : ""; }

/// Numbers apart by backslashes as short as they go; other text as it is.
std::string short_text(const std::string& text) {
  std::string word = text;
  word.erase(0, std::min(word.find_first_not_of(' '), word.size()));
  return core::is_decimal(word) ? short_number(core::to_double(word)) : word;
}

template <class T>
std::string binary_numbers(std::string_view value, bool big_endian) {
  std::string out;
  for (std::size_t at = 0; at + sizeof(T) <= value.size() && at < 3 * sizeof(T); at += sizeof(T)) {
    if (!out.empty()) out += '\\';
    out += short_number(double(geometry::number_at_in<T>(big_endian, value.data() + at)));
  }
  return out;
}

std::string value_at(const DicomItem& data, std::uint32_t tag, Form form, bool big_endian) {
  const DicomElement* element = data.find(tag);
  if (!element) return "";
  switch (form) {
    case Form::text:
      return short_text(text_of(data, tag, kMostMark));
    case Form::u16:
      return binary_numbers<std::uint16_t>(element->value, big_endian);
    case Form::u32:
      return binary_numbers<std::uint32_t>(element->value, big_endian);
    case Form::real32:
      return binary_numbers<float>(element->value, big_endian);
    case Form::real64:
      return binary_numbers<double>(element->value, big_endian);
    case Form::date_time: {
      const std::string text = text_of(data, tag, kMostMark);
      return date_and_time(text.substr(0, 8), text.size() > 8 ? text.substr(8, text.find_first_of("+-&") - 8) : "");
    }
  }
  return "";
}

/// The item of a frame's groups, or of those of all frames, in which a mark is looked for. Directions of diffusion are
/// a sequence within that of diffusion.
const DicomItem* item_at(const DicomItem* groups, const Place& place) {
  return item_of(place.sequence == kGradient ? item_of(groups, kDiffusion) : groups, place.sequence);
}

}  // namespace

const char* name_of(Mark mark) {
  constexpr const char* kNames[kMarks] = {"Temporal Position",
                                          "Acquisition Number",
                                          "Echo Number",
                                          "Echo Time",
                                          "Inversion Time",
                                          "Trigger Time",
                                          "Cardiac Phase Percentage",
                                          "Frame Reference Time",
                                          "Diffusion b-value",
                                          "Diffusion Gradient",
                                          "Image Type",
                                          "Complex Image Component",
                                          "Convolution Kernel",
                                          "KVP",
                                          "Acquisition Time",
                                          "Content Time",
                                          "Instance Number"};
  return kNames[std::size_t(mark)];
}

bool mark_less(const std::string& a, const std::string& b) {
  const bool a_number = core::is_decimal(a), b_number = core::is_decimal(b);
  if (a_number != b_number) return a_number;
  if (a_number && core::to_double(a) != core::to_double(b)) return core::to_double(a) < core::to_double(b);
  return a < b;
}

std::string text_of(const DicomItem& data, std::uint32_t tag, std::size_t most) {
  const DicomElement* element = data.find(tag);
  if (!element) return "";
  std::string text(element->value.substr(0, most));
  while (!text.empty() && (text.back() == ' ' || text.back() == '\0')) text.pop_back();
  return core::printable(text);
}

const DicomItem* item_of(const DicomItem* data, std::uint32_t sequence, std::size_t number) {
  const DicomElement* element = data ? data->find(sequence) : nullptr;
  return element && number < element->items.size() ? &element->items[number] : nullptr;
}

FrameMarks::FrameMarks(const DicomItem& data, const DicomItem* shared, bool big_endian)
    : m_big_endian(big_endian),
      m_acquisition_time(date_and_time(text_of(data, 0x00080022, kMostMark), text_of(data, 0x00080032, kMostMark))),
      m_content_time(date_and_time(text_of(data, 0x00080023, kMostMark), text_of(data, 0x00080033, kMostMark))) {
  for (const Place& place : kPlaces) {
    const DicomItem* item = place.sequence == 0 ? &data : item_at(shared, place);
    m_common.push_back(item ? value_at(*item, place.tag, place.form, big_endian) : "");
  }
}

Marks FrameMarks::of(const DicomItem* own) const {
  Marks out;
  for (std::size_t p = 0; p < std::size(kPlaces); ++p) {
    const Place& place = kPlaces[p];
    std::string& value = out[place.mark];
    if (!value.empty()) continue;
    const DicomItem* item = place.sequence == 0 ? nullptr : item_at(own, place);
    if (item) value = value_at(*item, place.tag, place.form, m_big_endian);
    if (value.empty()) value = m_common[p];
  }
  if (out[Mark::acquisition_time].empty()) out[Mark::acquisition_time] = m_acquisition_time;
  out[Mark::content_time] = m_content_time;
  return out;
}

}  // namespace trocar::volumes
