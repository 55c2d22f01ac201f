#include "yaml_text.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <locale>
#include <sstream>

namespace vacuum_gripper_sim {
namespace {

constexpr std::size_t kMaxDescription = 80;

std::string DescribeWhole(const YAML::Node& node) {
  if (!node.IsDefined() || node.IsNull()) return "(empty)";
  if (node.IsScalar()) return node.Scalar().empty() ? "(empty text)" : node.Scalar();
  std::string text = node.IsSequence() ? "[" : "{";
  for (YAML::const_iterator it = node.begin(); it != node.end(); ++it) {
    if (it != node.begin()) text += ", ";
    if (text.size() > kMaxDescription) break;
    const YAML::detail::iterator_value entry = *it;
    text += node.IsSequence() ? DescribeWhole(entry)
                              : DescribeWhole(entry.first) + ": " + DescribeWhole(entry.second);
  }
  return text + (node.IsSequence() ? "]" : "}");
}

}  // namespace

std::string Describe(const YAML::Node& node) {
  std::string text = DescribeWhole(node);
  if (text.size() > kMaxDescription) text = text.substr(0, kMaxDescription) + "...";
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

bool ParseDouble(const std::string& text, double* value) {
  // YAML's words for what a stream does not read.
  const bool negative = !text.empty() && text[0] == '-';
  const bool positive = !text.empty() && text[0] == '+';
  const std::string word = (negative || positive) ? text.substr(1) : text;
  if (word == ".inf" || word == ".Inf" || word == ".INF") {
    *value = (negative ? -1.0 : 1.0) * std::numeric_limits<double>::infinity();
    return true;
  }
  if (text == ".nan" || text == ".NaN" || text == ".NAN") {
    *value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  // Digits, point, sign and exponent only: neither hexadecimal nor leading blanks.
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string::npos) return false;
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  if (!(stream >> *value)) {
    // Too large for a double is a number too, only not a finite one; text leaves zero.
    if (std::abs(*value) != std::numeric_limits<double>::max()) return false;
    *value *= 2.0;
    return true;
  }
  return stream.peek() == std::istringstream::traits_type::eof();
}

bool IsQuoted(const YAML::Node& node) {
  return node.Tag() == "!" || node.Tag() == "tag:yaml.org,2002:str";
}

}  // namespace vacuum_gripper_sim
