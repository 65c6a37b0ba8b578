// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace SurfaceDiffusion
{

/// A part of a sentence. All kinds but Text are spelled in VTK as `Spelling`, and in other
/// interfaces in their own ways: names of settings as keywords, choices as words, cells as faces.
struct Word
{
  enum class Kind
  {
    Text,
    Setting, ///< the name of a setting
    Array, ///< the name of an input array
    Choice, ///< a value of a choice
    Switch, ///< a value of a switch, spelled as on and off or as its number
    Cell
  };

  Kind Type = Kind::Text;
  std::string Spelling;
  std::string Name = {}; ///< of the setting or of the array
  int Value = 0; ///< the number of a choice, 1 of a switch that is on and of several cells

  static Word Setting(const std::string& name) { return { Kind::Setting, name, name }; }
  /// label: follows the name in VTK, for instance the name that the user gave the array.
  static Word Array(const std::string& name, const std::string& label = "")
  {
    return { Kind::Array, name + label, name };
  }
  /// A value of the choice `setting`, spelled as its number, as its word, or as both.
  template <typename Enum>
  static Word Number(const std::string& setting, Enum value)
  {
    const auto number = static_cast<int>(value);
    return { Kind::Choice, std::to_string(number), setting, number };
  }
  template <typename Enum>
  static Word Choice(const std::string& setting, Enum value, const std::string& word)
  {
    return { Kind::Choice, word, setting, static_cast<int>(value) };
  }
  template <typename Enum>
  static Word NumberedChoice(const std::string& setting, Enum value, const std::string& word)
  {
    const auto number = static_cast<int>(value);
    return { Kind::Choice, std::to_string(number) + " " + word, setting, number };
  }
  static Word Switch(bool on) { return { Kind::Switch, on ? "on" : "off", {}, on ? 1 : 0 }; }
  static Word SwitchNumber(bool on) { return { Kind::Switch, on ? "1" : "0", {}, on ? 1 : 0 }; }
  static Word Cell() { return { Kind::Cell, "cell" }; }
  static Word Cells() { return { Kind::Cell, "cells", {}, 1 }; }
};

/// A message about settings and data, which each interface words.
class Sentence
{
public:
  Sentence() = default;
  Sentence(const char* text) // NOLINT(google-explicit-constructor)
    : Sentence(std::string(text))
  {
  }
  Sentence(const std::string& text) // NOLINT(google-explicit-constructor)
    : Sentence(Word{ Word::Kind::Text, text })
  {
  }
  Sentence(const Word& word) // NOLINT(google-explicit-constructor)
  {
    if (!word.Spelling.empty())
    {
      this->All.push_back(word);
    }
  }

  Sentence& operator<<(const Sentence& more);
  template <typename T, typename = std::enable_if_t<std::is_arithmetic_v<T>>>
  Sentence& operator<<(T number)
  {
    std::ostringstream text;
    text << number;
    return *this << Sentence(text.str());
  }

  const std::vector<Word>& Words() const { return this->All; }

  /// In the words of VTK. names: settings and arrays that are called otherwise.
  std::string Text(const std::map<std::string, std::string>& names = {}) const;

  friend bool operator==(const Sentence& a, const Sentence& b) { return a.Text() == b.Text(); }
  friend bool operator!=(const Sentence& a, const Sentence& b) { return !(a == b); }
  friend bool operator<(const Sentence& a, const Sentence& b) { return a.Text() < b.Text(); }

private:
  std::vector<Word> All;
};

std::ostream& operator<<(std::ostream& stream, const Sentence& sentence);

/// All of them in one, separated by semicolons.
Sentence Join(const std::vector<Sentence>& sentences);

/// An error whose message each interface words.
class InputError : public std::runtime_error
{
public:
  explicit InputError(const Sentence& message)
    : std::runtime_error(message.Text())
    , Words(message)
  {
  }
  const Sentence& Message() const { return this->Words; }

private:
  Sentence Words;
};

} // namespace SurfaceDiffusion
