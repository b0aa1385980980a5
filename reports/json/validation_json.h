#pragma once

#include "core/validation/run_blind.h"
#include "reports/json/json_document.h"

namespace stiffscope::reports {

/// Keys: seal, answers_sha256, seed, cases (list: truth, sizes in noises, answer, found, right), confusion
/// (truths, answers, counts: rows are truths), rates (by id: meaning, hits, trials, value, low, high at 95 %,
/// value null without trials), by_size, effects, outside, shrink (promised against true).
Json blindJson(const validation::BlindOptions& options, const validation::BlindResult& result);

}  // namespace stiffscope::reports
