// The order of the stages.
#include "mesher/delmesher.h"
