#pragma once
#include "core/base/result.hpp"
#include "core/config/visit.hpp"
#include "sim/lab/study_result.hpp"
namespace headland { struct Ebs221StudyConfig { int seed=1; std::string study; template<class V> void visit(V& v){ v("study",study,""); } }; inline Result<StudyResult> run_ebs221_study(const Ebs221StudyConfig&){ return StudyResult{}; } }
