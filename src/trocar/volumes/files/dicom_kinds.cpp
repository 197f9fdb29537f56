#include <trocar/core/text.hpp>
#include <trocar/volumes/files/dicom_kinds.hpp>

namespace trocar::volumes {
namespace {

constexpr std::string_view kClassRoot = "1.2.840.10008.5.1.4.1.1.";

enum class Remedy : unsigned char { open_series, export_labels };

struct Kind {
  std::string_view uid;       // behind the root: this one and those below it
  std::string_view modality;  // what files of this kind say, whatever their class is; empty: only the class counts
  const char* name;
  Remedy remedy = Remedy::open_series;
};
// The first that fits counts: those with longer identifiers come first.
constexpr Kind kKinds[] = {
    {"481.2", "RTDOSE", "an RT dose grid (RTDOSE)"},
    {"481.3", "RTSTRUCT", "an RT structure set (RTSTRUCT)", Remedy::export_labels},
    {"481.5", "RTPLAN", "an RT plan (RTPLAN)"},
    {"481.1", "RTIMAGE", "an RT image (RTIMAGE)"},
    {"481", "RTRECORD", "an object of radiotherapy"},
    {"66.4", "SEG", "a segmentation object (SEG)", Remedy::export_labels},
    {"66.5", "", "a surface segmentation", Remedy::export_labels},
    {"66", "REG", "an object without an image (raw data or a registration)"},
    {"67", "", "a real world value map"},
    {"30", "", "a parametric map"},
    {"11", "PR", "a presentation state (PR)"},
    {"88.59", "KO", "a key object selection (KO)"},
    {"88", "SR", "a structured report (SR)"},
    {"104", "DOC", "an enclosed document (DOC)"},
    {"9", "ECG", "a waveform"},
    {"4.2", "", "MR spectroscopy"},
    {"3", "US", "an ultrasound clip (US)"},
    {"6", "US", "an ultrasound image (US)"},
    {"77", "", "a visible-light image"},
    {"12", "", "an X-ray angiogram or fluoroscopy (XA, RF)"},
    {"1", "", "a plain X-ray image (CR, DX or MG)"},
};
constexpr std::string_view kSecondaryCapture = "7";

bool is_below(std::string_view uid, std::string_view row) {
  return !row.empty() && uid.substr(0, row.size()) == row && (uid.size() == row.size() || uid[row.size()] == '.');
}

std::string with_remedy(const char* name, Remedy remedy) {
  return remedy == Remedy::open_series ? tr("{}: open the CT or MR series instead", tr(name))
                                       : tr("{}: export it as NRRD or NIfTI and open that as a label map", tr(name));
}

}  // namespace

std::string other_than_slices(const DicomObject& object) {
  const std::string_view uid = object.sop_class;
  const std::string_view own = uid.substr(0, kClassRoot.size()) == kClassRoot ? uid.substr(kClassRoot.size()) : "";
  for (const Kind& kind : kKinds)
    if (is_below(own, kind.uid)) return with_remedy(kind.name, kind.remedy);
  for (const Kind& kind : kKinds)
    if (!kind.modality.empty() && object.modality == kind.modality) return with_remedy(kind.name, kind.remedy);
  if (is_dicom_directory(uid)) return tr("the list of a disc's files (DICOMDIR): open its folder instead");
  if (is_below(own, kSecondaryCapture) && !object.has_places)
    return with_remedy("a secondary capture (a picture of a screen or of paper)", Remedy::open_series);
  const auto has_type = [&](std::string_view word) {
    return ("\\" + object.image_type + "\\").find("\\" + std::string(word) + "\\") != std::string::npos;
  };
  if (has_type("LOCALIZER") && object.modality == "CT")
    return with_remedy("a localizer (a projection of the patient)", Remedy::open_series);
  if (has_type("MOSAIC"))
    return tr("a mosaic (many slices in one picture): convert the series to NIfTI first, for instance with dcm2niix");
  return "";
}

bool is_dicom_directory(std::string_view sop_class) { return sop_class == "1.2.840.10008.1.3.10"; }

}  // namespace trocar::volumes
