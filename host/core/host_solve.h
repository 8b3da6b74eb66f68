#pragma once

#include "pillarfield/host_solve.h"
