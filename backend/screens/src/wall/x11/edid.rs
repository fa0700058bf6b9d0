//! What a monitor or projector says of itself (VESA Enhanced EDID Standard, release A2).

const HEADER: [u8; 8] = [0, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0];
/// Four descriptors of 18 bytes stand from here on.
const DESCRIPTORS: std::ops::Range<usize> = 54..126;
/// What the descriptor of the product's name begins with.
const NAME: [u8; 5] = [0, 0, 0, 0xfc, 0];

/// The product's name, if the block has one.
pub(crate) fn product_name(block: &[u8]) -> Option<String> {
    let descriptors = block.strip_prefix(&HEADER).and(block.get(DESCRIPTORS))?;
    let text = descriptors.chunks_exact(18).find_map(|descriptor| descriptor.strip_prefix(&NAME))?;
    // It ends with a line feed, and is filled up with spaces.
    let text = text.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let name: String =
        text.iter().map(|&byte| char::from(byte)).filter(|c| c.is_ascii_graphic() || *c == ' ').collect();
    let name = name.trim();
    (!name.is_empty()).then(|| name.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(descriptor: &[u8]) -> Vec<u8> {
        let mut block = vec![0; 128];
        block[..8].copy_from_slice(&HEADER);
        block[54 + 36..][..descriptor.len()].copy_from_slice(descriptor);
        block
    }

    #[test]
    fn the_name_ends_at_its_line_feed() {
        let name = [&NAME[..], b"LF 3D\n       "].concat();
        assert_eq!(product_name(&block(&name)), Some("LF 3D".to_owned()));
    }

    #[test]
    fn blocks_without_a_name_have_none() {
        assert_eq!(product_name(&block(&[])), None);
        assert_eq!(product_name(&[]), None);
        assert_eq!(product_name(&block(&[&NAME[..], b"x"].concat())[1..]), None);
        assert_eq!(product_name(&block(&[&NAME[..], b"\n  "].concat())), None);
    }
}
