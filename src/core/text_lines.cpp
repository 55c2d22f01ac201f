#include "text_lines.h"

#include <locale.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <vector>

namespace vacuum_gripper_sim {
namespace {

bool IsBlank(const char c) { return c == ' ' || c == '\t' || c == '\r'; }

// std::from_chars for doubles came with GCC 11; strtod alone would follow the process's locale.
double StringToDouble(const char* begin, char** end) {
  static const locale_t classic = newlocale(LC_ALL_MASK, "C", nullptr);
  return strtod_l(begin, end, classic);
}

}  // namespace

TextLines::TextLines(const std::string& path) : path_(path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::invalid_argument(path + ": cannot be opened: " + std::strerror(errno));
  std::vector<char> block(1 << 16);
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    text_.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) throw std::invalid_argument(path + ": cannot be read");
}

bool TextLines::Next() {
  while (next_ < text_.size()) {
    begin_ = next_;
    end_ = std::min(text_.find('\n', begin_), text_.size());
    next_ = std::min(end_ + 1, text_.size());
    ++line_;
    if (!AtEndOfLine()) return true;
  }
  begin_ = end_ = text_.size();
  return false;
}

void TextLines::NextWithin(const std::string& what) {
  if (!Next()) Fail("the file ends within ", what);
}

void TextLines::SkipBlanks() {
  while (begin_ < end_ && IsBlank(text_[begin_])) ++begin_;
}

bool TextLines::AtEndOfLine() {
  SkipBlanks();
  return begin_ == end_;
}

std::size_t TextLines::EndOfWord() const {
  std::size_t end = begin_;
  while (end < end_ && !IsBlank(text_[end])) ++end;
  return end;
}

std::string TextLines::Rest() {
  SkipBlanks();
  std::size_t end = end_;
  while (end > begin_ && IsBlank(text_[end - 1])) --end;
  const std::string rest = text_.substr(begin_, end - begin_);
  begin_ = end_;
  return rest;
}

std::string TextLines::Word(const char* what) {
  if (AtEndOfLine()) Fail("the line ends before ", what);
  const std::size_t end = EndOfWord();
  const std::string word = text_.substr(begin_, end - begin_);
  begin_ = end;
  return word;
}

int TextLines::Int(const char* what) {
  return Int(what, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}

int TextLines::Int(const char* what, const int minimum, const int maximum) {
  if (AtEndOfLine()) Fail("the line ends before ", what);
  const std::size_t end = EndOfWord();
  int value = 0;
  const auto [stop, error] = std::from_chars(&text_[begin_], text_.data() + end, value);
  if (error == std::errc::invalid_argument || stop != text_.data() + end) {
    Fail(what, " is `", Word(what), "`, must be a whole number");
  }
  if (error != std::errc() || value < minimum || value > maximum) {
    Fail(what, " is ", Word(what), ", must be in ", minimum, " .. ", maximum);
  }
  begin_ = end;
  return value;
}

double TextLines::Finite(const char* what) {
  if (AtEndOfLine()) Fail("the line ends before ", what);
  const std::size_t end = EndOfWord();
  char* stop = nullptr;
  const double value = StringToDouble(&text_[begin_], &stop);
  if (stop != text_.data() + end) Fail(what, " is `", Word(what), "`, must be a number");
  if (!std::isfinite(value)) Fail(what, " is ", Word(what), ", must be finite");
  begin_ = end;
  return value;
}

void TextLines::ExpectEndOfLine() {
  if (!AtEndOfLine()) Fail("unexpected `", Rest(), "` at the end of the line");
}

int TextLines::MaxLinesLeft() const {
  const std::size_t bytes = text_.size() - next_;
  return static_cast<int>(
      std::min(bytes / 2 + 1, static_cast<std::size_t>(std::numeric_limits<int>::max())));
}

}  // namespace vacuum_gripper_sim
