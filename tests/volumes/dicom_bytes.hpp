// DICOM files for tests and seeds of the fuzzer, written by hand: explicit VR, little- or big-endian, not compressed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "volume_bytes.hpp"

namespace trocar::volumes {

/// Elements of a data set in the order in which they are put.
struct DicomElements {
  bool big = false;
  std::string bytes;

  void tag(unsigned group, unsigned element) {
    Packed out{big, {}};
    out.put(std::uint16_t(group));
    out.put(std::uint16_t(element));
    bytes += out.bytes;
  }
  void length16(std::size_t n) {
    Packed out{big, {}};
    out.put(std::uint16_t(n));
    bytes += out.bytes;
  }
  void length32(std::size_t n) {
    Packed out{big, {}};
    out.put(std::uint32_t(n));
    bytes += out.bytes;
  }
  void text(unsigned group, unsigned element, const char* vr, std::string value) {
    if (value.size() % 2 != 0) value += std::string(vr) == "UI" ? '\0' : ' ';
    tag(group, element);
    bytes += vr;
    length16(value.size());
    bytes += value;
  }
  void number(unsigned group, unsigned element, int value) {
    tag(group, element);
    bytes += "US";
    length16(2);
    length16(std::size_t(value));
  }
  void data(unsigned group, unsigned element, const char* vr, const std::string& value) {
    tag(group, element);
    bytes += vr;
    bytes.append(2, '\0');
    length32(value.size());
    bytes += value;
  }
  /// A sequence with one item for each call's elements.
  void sequence(unsigned group, unsigned element, int items, const std::function<void(int, DicomElements&)>& fill) {
    std::string inside;
    for (int i = 0; i < items; ++i) {
      DicomElements item{big, {}};
      fill(i, item);
      DicomElements head{big, {}};
      head.tag(0xfffe, 0xe000);
      head.length32(item.bytes.size());
      inside += head.bytes + item.bytes;
    }
    data(group, element, "SQ", inside);
  }
};

struct DicomFile {
  bool big = false;
  int columns = 3, rows = 2, frames = 0;  ///< frames 0: a plain slice
  int allocated = 16, stored = 12, is_signed = 0, samples = 1;
  std::string photometric = "MONOCHROME2", modality = "CT", series = "1.2.3", position = "-10\\-20\\30";
  std::string orientation = "1\\0\\0\\0\\1\\0", spacing = "0.75\\0.5", slope = "1", intercept = "-1024";
  int instance = 1;
  std::string object = "1.2.3.4", sop_class;  ///< empty: CT, by the number of frames
  bool frame_places = true;
  /// Further attributes, or others than the usual: group << 16 | element, the representation and the value. Without a
  /// representation the attribute is taken out.
  struct Attribute {
    std::uint32_t tag;
    std::string vr, value;
  };
  std::vector<Attribute> more;
  std::function<std::string(int)> frame_position;     ///< of a multi-frame file; default: backwards along the normal
  std::function<std::string(int)> frame_orientation;  ///< default: what all frames share
  std::function<int(int)> frame_time;                 ///< temporal position; default: not said
  std::function<int(int)> pixel = [](int i) { return 1000 + i; };

  std::string bytes() const {
    DicomElements meta;
    meta.text(0x0002, 0x0002, "UI", class_of());
    meta.text(0x0002, 0x0003, "UI", "1.2.3.4");
    meta.text(0x0002, 0x0010, "UI", big ? "1.2.840.10008.1.2.2" : "1.2.840.10008.1.2.1");
    DicomElements head;
    head.tag(0x0002, 0x0000);
    head.bytes += "UL";
    head.length16(4);
    head.length32(meta.bytes.size());
    std::string out(128, '\0');
    out += "DICM";
    out += head.bytes;
    out += meta.bytes;
    return out += body();
  }

 private:
  std::string class_of() const {
    const std::string root = "1.2.840.10008.5.1.4.1.1.";
    return root + (!sop_class.empty() ? sop_class : frames > 0 ? "2.1" : "2");
  }

  std::string body() const {
    std::map<std::uint32_t, std::string> elements;
    const auto text = [&](std::uint32_t tag, const char* vr, const std::string& value) {
      DicomElements one{big, {}};
      one.text(tag >> 16, tag & 0xffff, vr, value);
      elements[tag] = one.bytes;
    };
    const auto number = [&](std::uint32_t tag, int value) {
      DicomElements one{big, {}};
      one.number(tag >> 16, tag & 0xffff, value);
      elements[tag] = one.bytes;
    };
    text(0x00080016, "UI", class_of());
    text(0x00080018, "UI", object);
    text(0x00080060, "CS", modality);
    text(0x0008103e, "LO", "by hand");
    if (frames == 0) text(0x00180050, "DS", "2");
    text(0x0020000e, "UI", series);
    text(0x00200013, "IS", std::to_string(instance));
    if (frames == 0) {
      text(0x00200032, "DS", position);
      text(0x00200037, "DS", orientation);
    }
    number(0x00280002, samples);
    text(0x00280004, "CS", photometric);
    if (frames > 0) text(0x00280008, "IS", std::to_string(frames));
    number(0x00280010, rows);
    number(0x00280011, columns);
    if (frames == 0) text(0x00280030, "DS", spacing);
    number(0x00280100, allocated);
    number(0x00280101, stored);
    number(0x00280102, stored - 1);
    number(0x00280103, is_signed);
    if (frames == 0) {
      text(0x00281052, "DS", intercept);
      text(0x00281053, "DS", slope);
    }
    if (frames > 0) groups(elements);
    elements[0x7fe00010] = pixels();
    for (const Attribute& a : more) {
      if (a.vr.empty())
        elements.erase(a.tag);
      else
        text(a.tag, a.vr.c_str(), a.value);
    }
    std::string out;
    for (const auto& [tag, bytes] : elements) out += bytes;
    return out;
  }

  std::string pixels() const {
    Packed all{big, {}};
    for (int i = 0; i < rows * columns * samples * std::max(frames, 1); ++i) {
      if (allocated == 8)
        all.put(std::uint8_t(pixel(i)));
      else
        all.put(std::uint16_t(pixel(i)));
    }
    if (all.bytes.size() % 2 != 0) all.bytes += '\0';
    DicomElements out{big, {}};
    out.data(0x7fe0, 0x0010, "OW", all.bytes);
    return out.bytes;
  }

  void frame_group(int f, DicomElements& own) const {
    if (frame_time)
      own.sequence(0x0020, 0x9111, 1, [&](int, DicomElements& e) {
        e.tag(0x0020, 0x9128);
        e.bytes += "UL";
        e.length16(4);
        e.length32(std::size_t(frame_time(f)));
      });
    own.sequence(0x0020, 0x9113, 1, [&](int, DicomElements& e) {
      e.text(0x0020, 0x0032, "DS",
             frame_position ? frame_position(f) : "-10\\-20\\" + std::to_string(30 + 2 * (frames - 1 - f)));
    });
    if (frame_orientation)
      own.sequence(0x0020, 0x9116, 1,
                   [&](int, DicomElements& e) { e.text(0x0020, 0x0037, "DS", frame_orientation(f)); });
  }

  /// What an enhanced CT says of all frames and of each; the frames run backwards along the normal.
  void groups(std::map<std::uint32_t, std::string>& elements) const {
    DicomElements all{big, {}}, each{big, {}};
    all.sequence(0x5200, 0x9229, 1, [&](int, DicomElements& shared) {
      shared.sequence(0x0020, 0x9116, 1, [&](int, DicomElements& e) { e.text(0x0020, 0x0037, "DS", orientation); });
      shared.sequence(0x0028, 0x9110, 1, [&](int, DicomElements& e) {
        e.text(0x0018, 0x0050, "DS", "2");
        e.text(0x0028, 0x0030, "DS", spacing);
      });
      shared.sequence(0x0028, 0x9145, 1, [&](int, DicomElements& e) {
        e.text(0x0028, 0x1052, "DS", intercept);
        e.text(0x0028, 0x1053, "DS", slope);
        e.text(0x0028, 0x1054, "LO", "HU");
      });
    });
    elements[0x52009229] = all.bytes;
    if (!frame_places) return;
    each.sequence(0x5200, 0x9230, frames, [&](int f, DicomElements& own) { frame_group(f, own); });
    elements[0x52009230] = each.bytes;
  }
};

}  // namespace trocar::volumes
