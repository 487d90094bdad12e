#include "core/recording.h"
