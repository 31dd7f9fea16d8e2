//! The air between eye and surfaces on the device.
use crate::gpu::Device;
use skylight::daylight::atmosphere::air::Air as Medium;
use skylight::daylight::sky::{Conditions, Daylight, SkyModel};
use skylight::passes::sky::air::Air;
use skylight::passes::sky::cube::SkyCube;
use skylight::scene::Bounds;

#[test]
fn table_of_the_air() {
    let mut device = Device::new();
    let mut cube = SkyCube::new(&device.context, 16).expect("a cube");
    let mut air = Air::new(&device.context, &Bounds::EMPTY).expect("air");
    let daylight = Daylight::new(&Conditions { model: SkyModel::Atmosphere, air: Medium::default(), ..Conditions::default() });
    device.run(|rec| { let sky = cube.record(rec, &daylight); air.record(rec, sky.air, &daylight, 100.0); });
    println!("{:?}", &device.read(air.image())[..4]);
}
