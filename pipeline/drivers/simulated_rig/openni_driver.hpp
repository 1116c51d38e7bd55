#pragma once

// OpenNI2's driver interface leaves these two to the plug-in.
#define XN_NEW(type, arg) new type(arg)
#define XN_DELETE(pointer) delete (pointer)

#include <Driver/OniDriverAPI.h>
