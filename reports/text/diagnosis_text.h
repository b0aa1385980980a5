#pragma once

#include <string>

#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"

namespace stiffscope::reports {

/// The diagnosis for people: the verdict with its reason, the candidates with how far each shrinks the gap,
/// where the gap lies, stiffnesses before and after, what could not be tested and what to measure next.
std::string diagnosisText(const campaign::Campaign& campaign, const diagnosis::Diagnosis& diagnosis);

}  // namespace stiffscope::reports
