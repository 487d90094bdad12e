#include "control/tracker.h"
