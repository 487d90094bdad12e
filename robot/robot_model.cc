#include "robot/robot_model.h"
