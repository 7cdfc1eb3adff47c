// The stability suite in full: a line for every case that failed or could not be judged, and the table by
// family in Markdown. The exit code is 1 where a promise is broken.
#include "tests/stress/report.hpp"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string_view>

using namespace flyball::stress;

int main(int count, char** arguments) {
  CaseChoice choice;
  std::string table, filter;
  for (int i = 1; i < count; ++i) {
    const std::string_view key = arguments[i];
    if (key == "--short") {
      choice.thinned = true;
    } else if (i + 1 < count && key == "--csv") {
      table = arguments[++i];
    } else if (i + 1 < count && key == "--filter") {
      filter = arguments[++i];
    } else if (i + 1 < count && key == "--seeds" && (choice.seeds = std::atoi(arguments[i + 1])) > 0) {
      ++i;
    } else {
      std::cerr << "usage: flyball_stress [--csv FILE] [--filter TEXT] [--seeds N] [--short]\n"
                   "  --csv     a line a case: true and estimated error, iterations, net, time, remark\n"
                   "  --filter  only the cases with TEXT in \"family: name\"\n"
                   "  --seeds   random cases of each kind (8)\n"
                   "  --short   fewer values, as the test does\n";
      return 2;
    }
  }
  Cases cases = all_cases(choice);
  std::erase_if(cases,
                [&](const Case& c) { return (c.family + ": " + c.name).find(filter) == std::string::npos; });
  const std::vector<Result> results = run_cases(cases, 2, true);
  std::cout << failures(results) << '\n' << markdown(results);
  if (!table.empty() && !(std::ofstream(table) << csv(results))) {
    std::cerr << "cannot write " << table << '\n';
    return 2;
  }
  return good(summarize(results)) ? 0 : 1;
}
