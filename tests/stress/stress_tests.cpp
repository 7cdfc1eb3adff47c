// The stability suite's short form: the same families with fewer values.
#include "tests/catch.hpp"
#include "tests/stress/report.hpp"

using namespace flyball::stress;

TEST_CASE("stress: extreme numbers end in an honest answer or a refusal with its reason") {
  CaseChoice choice;
  choice.thinned = true;
  choice.seeds = 1;
  const std::vector<Result> results = run_cases(all_cases(choice), 1, false);
  const Summary all = summarize(results);
  INFO(failures(results));
  INFO(markdown(results));
  CHECK(all.failed == 0);
  CHECK(all.unclear <= all.cases / 50);
  CHECK(all.share() >= 0.99);
  CHECK(all.worst <= 100);
  CHECK(all.solved >= all.cases * 3 / 4);
}
