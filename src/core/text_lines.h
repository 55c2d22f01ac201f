#pragma once

#include <cstddef>
#include <sstream>
#include <stdexcept>
#include <string>

namespace vacuum_gripper_sim {

/** A text file read line by line and word by word; every complaint is "file:line: reason".

 Words are separated by blanks. Numbers are read the same way in every locale. */
class TextLines {
 public:
  /// Loads a file. @throws std::invalid_argument if it cannot be read.
  explicit TextLines(const std::string& path);

  /// Goes to the next line that is not blank. @returns false at the end of the file.
  bool Next();
  /// Like Next(), but complains that the file ends within `what`.
  void NextWithin(const std::string& what);

  bool AtEndOfLine();
  /// The rest of the line without blanks at its ends.
  std::string Rest();
  std::string Word(const char* what);
  int Int(const char* what);
  /// An integer in minimum .. maximum.
  int Int(const char* what, int minimum, int maximum);
  double Finite(const char* what);
  void ExpectEndOfLine();

  /// Upper bound of the lines that are left: what a file may ask to allocate.
  int MaxLinesLeft() const;

  template <typename... Parts>
  [[noreturn]] void Fail(const Parts&... parts) const {
    std::ostringstream message;
    message << path_ << ":" << (line_ == 0 ? 1 : line_) << ": ";
    (message << ... << parts);
    throw std::invalid_argument(message.str());
  }

 private:
  /// Moves begin_ over blanks.
  void SkipBlanks();
  std::size_t EndOfWord() const;

  std::string path_;
  std::string text_;
  std::size_t next_{0};            ///< Start of the line after the current one.
  std::size_t begin_{0}, end_{0};  ///< What is left of the current line.
  int line_{0};                    ///< Number of the current line, from 1.
};

}  // namespace vacuum_gripper_sim
