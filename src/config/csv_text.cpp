#include "csv_text.h"

#include <locale>

namespace vacuum_gripper_sim {

void BeginCsv(const std::string& header, std::ostream* stream) {
  constexpr int kDigits = 12;
  stream->imbue(std::locale::classic());
  stream->precision(kDigits);
  *stream << header << '\n';
}

void WriteVector(const Eigen::Vector3d& v, std::ostream* stream) {
  *stream << ',' << v.x() << ',' << v.y() << ',' << v.z();
}

std::string CsvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string cell = "\"";
  for (const char c : text) {
    if (c == '"') cell += c;
    cell += c;
  }
  return cell + '"';
}

}  // namespace vacuum_gripper_sim
