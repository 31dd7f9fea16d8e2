// Format of display values as storage images.
#ifdef HALF
#define DISPLAY_FORMAT rgba16f
#else
#define DISPLAY_FORMAT rgba8
#endif
