// The commands with their options as values, for the manual and for shells that complete them.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace flyball::cli {

struct OptionDescription {
  std::vector<std::string> names;   // "-o", "--out"; of a positional its word
  std::string value;                // what it takes, "TEXT" or "FLOAT"; empty: nothing
  std::vector<std::string> choices; // what it may be, where that is a list
  std::string limits;               // in words, of a number
  std::string text, standard;
  bool required = false, repeated = false;
};

struct CommandDescription {
  std::string name; // empty: the program by itself
  std::string summary;
  std::vector<OptionDescription> positionals, options;
  std::string example;
};

struct ProgramDescription {
  CommandDescription program;
  std::vector<CommandDescription> commands;
};

// Without what is hidden from the help.
ProgramDescription describe(const CLI::App& app);

} // namespace flyball::cli
