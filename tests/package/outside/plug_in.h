#pragma once

extern "C" int CountPlannersAndPredictors();
