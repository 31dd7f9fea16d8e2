//! x
use skylight::scene::{LoadOptions, load};
fn main() {
    for path in std::env::args().skip(1) {
        let p = std::path::Path::new(&path);
        let name = path
            .rsplit_once("test-models/")
            .map_or(path.as_str(), |x| x.1);
        match load(p, &LoadOptions::default()) {
            Ok(l) => println!(
                "{}\t{name}\t{}\t{}",
                if l.scene.warnings.is_empty() {
                    "drawn"
                } else {
                    "warned"
                },
                l.scene.triangles(),
                l.scene.warnings.join(" | ")
            ),
            Err(e) => println!("refused\t{name}\t{}\t{}", e.to_string().len(), e),
        }
    }
}
