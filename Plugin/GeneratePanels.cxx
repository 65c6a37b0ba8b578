// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Run/Solve.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// Usage: GeneratePanels FILE.xml OUTPUT.xml
/// Writes the server manager's XML of a filter from the tracked file, which has short elements in place
/// of properties. What a setting is (type, range, words, default, documentation) comes from its
/// declaration in Run; SurfaceDiffusionAlgorithm.xml describes the elements.
namespace SurfaceDiffusion
{
namespace
{

using Attributes = std::map<std::string, std::string>;

[[noreturn]] void Fail(const std::string& text)
{
  throw std::runtime_error(text);
}

std::string Escape(const std::string& text)
{
  std::string result;
  for (const char c : text)
  {
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return result;
}

std::string Text(double value)
{
  std::ostringstream stream;
  stream.precision(15);
  stream << value;
  return stream.str();
}

/// The XML of a setting, but for what its element says.
struct Panel
{
  std::string Tag, Default, Domain, Documentation, OnlyIf;
  std::map<std::string, std::string> Words; ///< of a choice, by value
  bool CanBeAnimated = true;
  int Elements = 1;
};

class PanelMaker : public SettingVisitor
{
public:
  using SettingVisitor::Choice;

  explicit PanelMaker(const std::string& model)
  {
    for (const NamedSettings& entry : SettingsOfModels)
    {
      if (model == entry.Function)
      {
        entry.Make()->Visit(*this);
        return;
      }
    }
    Fail("there are no settings of \"" + model + '"');
  }

  /// Null if the model does not have the setting.
  const Panel* Known(const std::string& name) const
  {
    const auto found = this->Panels.find(name);
    return found != this->Panels.end() ? &found->second : nullptr;
  }
  const Panel& Find(const std::string& name) const
  {
    const Panel* const found = this->Known(name);
    if (!found)
    {
      Fail("there is no setting " + name);
    }
    return *found;
  }

  void Number(const SettingInfo& info, double& value, const SettingRange& range) override
  {
    this->Add(info, "DoubleVectorProperty", Text(value), RangeOf("DoubleRangeDomain", range));
  }
  void Integer(const SettingInfo& info, int& value, const SettingRange& range) override
  {
    this->Add(info, "IntVectorProperty", std::to_string(value), RangeOf("IntRangeDomain", range))
      .CanBeAnimated = false;
  }
  void Numbers(
    const SettingInfo& info, std::vector<double>& values, const SettingRange& range) override
  {
    std::string text;
    for (const double value : values)
    {
      text += (text.empty() ? "" : " ") + Text(value);
    }
    this->Add(
          info, "DoubleVectorProperty", text, RangeOf("DoubleRangeDomain", range, values.size()))
      .Elements = static_cast<int>(values.size());
  }
  void Switch(const SettingInfo& info, bool& value) override
  {
    this->Add(info, "IntVectorProperty", value ? "1" : "0", "<BooleanDomain name=\"bool\"/>")
      .CanBeAnimated = false;
  }
  void Choice(const SettingInfo& info, int& value, const std::vector<const char*>& words,
    const std::vector<bool>& allowed) override
  {
    Panel& panel = this->Add(info, "IntVectorProperty", std::to_string(value), {});
    panel.CanBeAnimated = false;
    for (std::size_t w = 0; w < words.size(); ++w)
    {
      if (allowed.empty() || allowed[w])
      {
        panel.Words[std::to_string(w)] = words[w];
      }
    }
  }

private:
  /// A slider where both ends are near.
  static std::string RangeOf(const char* tag, const SettingRange& range, std::size_t elements = 1)
  {
    constexpr double far = 1000.0;
    if (!(range.Low < range.High))
    {
      return {};
    }
    const double low = range.HasSpecial ? std::min(range.Low, range.Special) : range.Low;
    std::string ends[2];
    for (std::size_t e = 0; e < elements; ++e)
    {
      ends[0] += (e > 0 ? " " : "") + Text(low);
      ends[1] += (e > 0 ? " " : "") + Text(range.High);
    }
    const std::string text = std::string("<") + tag + " name=\"range\" min=\"" + ends[0] + '"';
    return text + (range.High <= far ? " max=\"" + ends[1] + '"' : "") + "/>";
  }
  Panel& Add(
    const SettingInfo& info, const char* tag, const std::string& value, const std::string& domain)
  {
    Panel& panel = this->Panels[info.Name];
    panel = {};
    panel.Tag = tag;
    panel.Default = value;
    panel.Domain = domain;
    panel.Documentation = info.Documentation;
    panel.OnlyIf = info.OnlyIf;
    return panel;
  }

  std::map<std::string, Panel> Panels;
};

/// The number of a word of a choice, of the first model that has it.
std::string NumberOfWord(const std::string& setting, const std::string& word)
{
  for (const NamedSettings& model : SettingsOfModels)
  {
    const PanelMaker maker(model.Function);
    const Panel* const panel = maker.Known(setting);
    for (const auto& [number, known] : panel ? panel->Words : Attributes())
    {
      if (known == word)
      {
        return number;
      }
    }
  }
  Fail(setting + " has no word " + word);
}

/// A condition of SettingInfo::OnlyIf as ParaView's decorators.
class Condition
{
public:
  explicit Condition(std::string text)
    : Source(std::move(text))
  {
  }

  std::string Decorators(const std::string& mode)
  {
    this->Mode = mode;
    std::string result;
    while (this->At < this->Source.size())
    {
      const std::string found = this->Expression();
      result += found.rfind("<Expression", 0) == 0
        ? "<PropertyWidgetDecorator type=\"CompositeDecorator\">" + found +
          "</PropertyWidgetDecorator>"
        : found;
      if (this->At < this->Source.size() && !this->Takes(";"))
      {
        Fail("\"" + this->Source + "\" is no condition");
      }
    }
    return result;
  }

private:
  bool Takes(const std::string& word)
  {
    while (this->At < this->Source.size() && this->Source[this->At] == ' ')
    {
      ++this->At;
    }
    const bool found = this->Source.compare(this->At, word.size(), word) == 0;
    this->At += found ? word.size() : 0;
    return found;
  }
  std::string Expression()
  {
    std::string text = this->Term();
    const bool isAnd = this->Takes("and ");
    const std::string word = isAnd ? "and " : "or ";
    if (!isAnd && !this->Takes(word))
    {
      return text;
    }
    do
    {
      text += this->Term();
    } while (this->Takes(word));
    return std::string("<Expression type=\"") + (isAnd ? "and" : "or") + "\">" + text +
      "</Expression>";
  }
  std::string Term()
  {
    if (this->Takes("("))
    {
      const std::string text = this->Expression();
      return this->Takes(")") ? text : (Fail("a ) is missing in \"" + this->Source + '"'), text);
    }
    const bool isAbsent = this->Takes("!");
    const std::string name = this->Until("!= );");
    if (name == "CellData")
    {
      return this->Decorator("InputArray\" index=\"3", "1", false);
    }
    if (this->At == this->Source.size() ||
      std::string(" );").find(this->Source[this->At]) != std::string::npos)
    {
      return this->Decorator(name + "\" index=\"4", "", !isAbsent);
    }
    const bool isInverse = this->Takes("!");
    if (isAbsent || !this->Takes("="))
    {
      Fail("\"" + this->Source + "\" is no condition");
    }
    std::string value = this->Until(" );");
    if (std::isalpha(static_cast<unsigned char>(value[0])) != 0)
    {
      value = NumberOfWord(name, value);
    }
    return this->Decorator(name, value, isInverse);
  }
  /// The text up to one of these characters, which is passed.
  std::string Until(const char* ends)
  {
    this->Takes("");
    const std::size_t from = this->At;
    this->At = std::min(this->Source.find_first_of(ends, from), this->Source.size());
    return this->Source.substr(from, this->At - from);
  }
  std::string Decorator(const std::string& name, const std::string& value, bool isInverse) const
  {
    return "<PropertyWidgetDecorator type=\"GenericDecorator\" mode=\"" + this->Mode +
      "\" property=\"" + name + "\" value=\"" + value + '"' +
      (isInverse ? " inverse=\"1\"/>" : "/>");
  }

  const std::string Source;
  std::string Mode;
  std::size_t At = 0;
};

/// A start tag, and for the short elements what is between it and its end.
struct Element
{
  std::string Name, Content;
  Attributes Given;
  std::size_t End = 0;

  std::string Take(const std::string& name, const std::string& otherwise = {}) const
  {
    const auto found = this->Given.find(name);
    return found == this->Given.end() ? otherwise : found->second;
  }
};

class Writer
{
public:
  explicit Writer(std::string text)
    : Source(std::move(text))
  {
  }

  std::string Write()
  {
    std::size_t at = 0;
    while (true)
    {
      const std::size_t next = this->Source.find('<', at);
      this->Result += this->Source.substr(at, next - at);
      if (next == std::string::npos)
      {
        return this->Result;
      }
      at = this->WriteFrom(next);
    }
  }

private:
  /// The place after what begins at `at`.
  std::size_t WriteFrom(std::size_t at)
  {
    if (this->Source.compare(at, 4, "<!--") == 0)
    {
      return this->Copy(at, this->Source.find("-->", at) + 3);
    }
    const Element element = this->Read(at);
    if (element.Name == "Settings")
    {
      this->Model = element.Take("of");
    }
    else if (element.Name == "Setting" || element.Name == "Array" || element.Name == "Information")
    {
      this->Names.push_back(element.Take("name"));
      this->Result += element.Name == "Setting" ? this->SettingOf(element)
        : element.Name == "Array"               ? ArrayOf(element)
                                                : InformationOf(element);
    }
    else if (element.Name == "PropertyGroup")
    {
      this->Names.clear();
      this->Group = element.Take("label");
    }
    else if (element.Name == "/PropertyGroup")
    {
      this->Result += "<PropertyGroup label=\"" + this->Group + "\">";
      for (const std::string& name : this->Names)
      {
        this->Result += "<Property name=\"" + name + "\"/>";
      }
      this->Result += "</PropertyGroup>";
    }
    else
    {
      constexpr std::size_t length = sizeof("VectorProperty") - 1;
      if (element.Name.front() != '/' && element.Name.size() > length &&
        element.Name.compare(element.Name.size() - length, length, "VectorProperty") == 0)
      {
        this->Names.push_back(element.Take("name"));
      }
      return this->Copy(at, element.End);
    }
    return element.End;
  }
  std::size_t Copy(std::size_t from, std::size_t to)
  {
    this->Result += this->Source.substr(from, to - from);
    return to;
  }

  Element Read(std::size_t at) const
  {
    const std::string& text = this->Source;
    Element element;
    element.End = text.find('>', at) + 1;
    std::size_t next = text.find_first_of(" \n/>", at + 2);
    element.Name = text.substr(at + 1, next - at - 1);
    for (std::size_t quote = text.find('"', next); quote < element.End;
         quote = text.find('"', next))
    {
      const std::size_t name = text.find_first_not_of(" \n", next);
      const std::size_t close = text.find('"', quote + 1);
      element.Given[text.substr(name, quote - 1 - name)] =
        text.substr(quote + 1, close - quote - 1);
      next = close + 1;
    }
    if (text[element.End - 2] != '/' &&
      (element.Name == "Setting" || element.Name == "Array" || element.Name == "Information"))
    {
      const std::string end = "</" + element.Name + ">";
      const std::size_t close = text.find(end, element.End);
      element.Content = text.substr(element.End, close - element.End);
      element.End = close + end.size();
    }
    return element;
  }

  static std::string Open(const std::string& tag, const Element& element, const Attributes& more)
  {
    std::string text = "<" + tag;
    Attributes all = more;
    for (const char* const name : { "name", "label", "override", "panel_visibility", "panel_widget",
           "animateable", "default_values" })
    {
      if (!element.Take(name).empty())
      {
        all[name] = element.Take(name);
      }
    }
    for (const auto& [name, value] : all)
    {
      text += " " + name + "=\"" + value + '"';
    }
    return text + ">";
  }
  static std::string HintsOf(const Element& element, const std::string& onlyIf, bool hasDefault)
  {
    const std::string hints = (hasDefault ? "" : "<NoDefault/>") +
      Condition(onlyIf).Decorators("visibility") +
      Condition(element.Take("enabled_when")).Decorators("enabled_state");
    return hints.empty() ? hints : "<Hints>" + hints + "</Hints>";
  }
  static std::string Required()
  {
    return "<RequiredProperties><Property name=\"Input\" function=\"Input\"/></RequiredProperties>";
  }
  static std::string Documentation(const std::string& text)
  {
    return "<Documentation>" + text + "</Documentation>";
  }

  std::string SettingOf(const Element& element) const
  {
    const std::string name = element.Take("name");
    if (!element.Take("when").empty())
    {
      Fail("the condition of " + name + " belongs into its declaration, as OnlyIf");
    }
    const Panel panel = PanelMaker(element.Take("of", this->Model)).Find(name);
    Attributes more = { { "command", "Set" + name },
      { "number_of_elements", std::to_string(panel.Elements) },
      { "default_values", panel.Default } };
    if (!panel.CanBeAnimated)
    {
      more["animateable"] = "0";
    }
    const std::string scale = element.Take("scale");
    const std::string least = element.Take("min");
    std::string domain = panel.Domain;
    if (!scale.empty())
    {
      domain = "<BoundsDomain name=\"range\" mode=\"scaled_extent\" scale_factor=\"" + scale +
        "\">" + Required() + "</BoundsDomain>";
    }
    else if (!least.empty())
    {
      domain = "<DoubleRangeDomain name=\"range\" min=\"" + least + "\"/>";
    }
    else if (!panel.Words.empty())
    {
      domain = Menu(panel.Words, element.Take("order"));
    }
    const bool hasDefault = scale.empty() || !element.Take("starts_in_domain").empty();
    return Open(panel.Tag, element, more) + domain +
      Documentation(Escape(panel.Documentation) + element.Content) +
      HintsOf(element, panel.OnlyIf, hasDefault) + "</" + panel.Tag + ">";
  }
  /// order: the values in the order of the menu, if it is not that of the words.
  static std::string Menu(const std::map<std::string, std::string>& words, const std::string& order)
  {
    std::vector<std::string> values;
    for (const auto& word : words)
    {
      values.push_back(word.first);
    }
    if (!order.empty())
    {
      std::istringstream stream(order);
      values.assign(std::istream_iterator<std::string>(stream), {});
    }
    std::string text = "<EnumerationDomain name=\"enum\">";
    for (const std::string& value : values)
    {
      text += "<Entry text=\"" + words.at(value) + "\" value=\"" + value + "\"/>";
    }
    return text + "</EnumerationDomain>";
  }
  /// An input array that may be none.
  static std::string ArrayOf(const Element& element)
  {
    const std::string tag = "StringVectorProperty";
    return Open(tag, element,
             { { "command", "SetInputArrayToProcess" }, { "number_of_elements", "5" },
               { "element_types", "0 0 0 0 2" }, { "default_values", element.Take("index") },
               { "animateable", "0" } }) +
      "<ArrayListDomain name=\"array_list\" attribute_type=\"" + element.Take("type", "Scalars") +
      "\" input_domain_name=\"" + element.Take("domain") +
      "\" data_type=\"VTK_DATA_ARRAY\" none_string=\"\">" + Required() + "</ArrayListDomain>" +
      Documentation(element.Content) + HintsOf(element, element.Take("when"), false) + "</" + tag +
      ">";
  }
  static std::string InformationOf(const Element& element)
  {
    const std::string type = element.Take("type", "Double");
    const std::string tag = type + "VectorProperty";
    return Open(tag, element,
             { { "command", "Get" + element.Take("name") }, { "information_only", "1" } }) +
      "<Simple" + type + "InformationHelper/>" + Documentation(element.Content) + "</" + tag + ">";
  }

  const std::string Source;
  std::string Result, Model, Group;
  std::vector<std::string> Names; ///< of the properties of the present group
};

} // namespace
} // namespace SurfaceDiffusion

int main(int count, char** arguments)
{
  try
  {
    if (count != 3)
    {
      throw std::runtime_error("two arguments are needed: FILE.xml OUTPUT.xml");
    }
    std::ifstream input(arguments[1]);
    std::stringstream text;
    text << input.rdbuf();
    const std::string result = SurfaceDiffusion::Writer(text.str()).Write();
    std::ofstream output(arguments[2]);
    output << result << std::flush;
    if (!input || !output)
    {
      throw std::runtime_error("the file cannot be read, or the output cannot be written");
    }
  }
  catch (const std::exception& error)
  {
    std::cerr << (count > 1 ? arguments[1] : "GeneratePanels") << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}
