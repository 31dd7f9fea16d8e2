// For LD_PRELOAD. Mesa's software driver presents to X11 by PutImage with a depth of 24, whatever the window has, and the server refuses that where
// the screen has 30 bits: the window stays black. This says DEPTH instead.

#include <dlfcn.h>
#include <stdint.h>

typedef struct {
    unsigned sequence;
} cookie;
typedef cookie (*put)(void *, uint8_t, uint32_t, uint32_t, uint16_t, uint16_t, int16_t, int16_t, uint8_t, uint8_t, uint32_t, const uint8_t *);

cookie xcb_put_image(void *connection, uint8_t format, uint32_t window, uint32_t gc, uint16_t width, uint16_t height, int16_t x, int16_t y,
                     uint8_t left_pad, uint8_t depth, uint32_t bytes, const uint8_t *data) {
    (void)depth;
    put real = (put)dlsym(dlopen("libxcb.so.1", RTLD_NOW), "xcb_put_image");
    return real(connection, format, window, gc, width, height, x, y, left_pad, DEPTH, bytes, data);
}
