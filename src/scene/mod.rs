//! Models, materials, textures, cameras and scene files, without a device.
