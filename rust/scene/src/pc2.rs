//! POINTCACHE2, version 1: the positions of one cloth, frame after frame, as Blender's Mesh Cache modifier plays them.
//!
//! ```text
//! byte  0  "POINTCACHE2\0"
//!      12  i32  version, 1
//!      16  i32  vertices
//!      20  f32  first frame
//!      24  f32  frames a sample, 1
//!      28  i32  samples
//!      32  f32  x, y, z of every vertex, sample after sample
//! ```
//! All little-endian. The file on disk is a valid prefix of the whole at any moment: a sample's data is written first, the
//! number of samples after it.

use std::fs::{File, OpenOptions};
use std::io::{BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use boucle_geometry::Vector;
use xxhash_rust::xxh3::xxh3_64;

use crate::error::{Error, Result};

const HEADER_BYTES: u64 = 32;
const SAMPLE_COUNT_AT: u64 = 28;
/// How every file begins.
pub(crate) const MAGIC: &[u8; 12] = b"POINTCACHE2\0";

/// A PC2 file that is being written.
#[derive(Debug)]
pub struct Writer {
    path: PathBuf,
    file: File,
    vertex_count: u32,
    sample_count: u32,
    /// The bytes of one sample, kept between samples.
    buffer: Vec<u8>,
}

impl Writer {
    /// Begins a file, replacing any old one.
    ///
    /// # Errors
    /// [`Error::Cache`] when it cannot be written.
    pub fn create(path: &Path, vertex_count: u32, first_frame: i32) -> Result<Self> {
        let write = || {
            let mut file = File::create(path)?;
            file.write_all(&Header { vertex_count, first_frame, sample_count: 0 }.bytes())?;
            Ok(file)
        };
        let file = write().map_err(|error| Error::cache(path, "written", &error))?;
        Ok(Self { path: path.to_owned(), file, vertex_count, sample_count: 0, buffer: Vec::new() })
    }

    /// Takes up a file after its first samples, whose hashes are those that `append` gave, and forgets those behind.
    ///
    /// # Errors
    /// [`Error::Cache`] when it cannot be read or written, is of another cloth, or does not hold these samples.
    pub fn resume(
        path: &Path,
        vertex_count: u32,
        first_frame: i32,
        hashes: &[u64],
    ) -> Result<Self> {
        let sample_count = hashes.len() as u32;
        let open = || {
            let mut file = OpenOptions::new().read(true).write(true).open(path)?;
            let header = Header::read(&mut file)?;
            Ok((file, header))
        };
        let (mut file, header) = open().map_err(|error| Error::cache(path, "read", &error))?;
        let same = header.vertex_count == vertex_count && header.first_frame == first_frame;
        if !same || header.sample_count < sample_count {
            return Err(Error::Cache(format!(
                "{} holds {} samples of {} vertices from frame {}, not the {sample_count} of \
                 {vertex_count} from frame {first_frame} that the checkpoint goes on from; \
                 accepted: the file as the bake left it, or a bake without --resume",
                path.display(),
                header.sample_count,
                header.vertex_count,
                header.first_frame
            )));
        }
        if let Some(sample) = first_changed(&mut file, vertex_count, hashes) {
            return Err(Error::Cache(format!(
                "{}: frame {} is not as the bake wrote it; accepted: the file as the bake left it, \
                 or a bake without --resume",
                path.display(),
                i64::from(first_frame) + sample as i64
            )));
        }
        let buffer = Vec::new();
        let mut writer = Self { path: path.to_owned(), file, vertex_count, sample_count, buffer };
        writer.begin_with(Header { vertex_count, first_frame, sample_count })?;
        writer.truncate(sample_count)?;
        Ok(writer)
    }

    /// How many samples the file holds.
    #[must_use]
    pub fn sample_count(&self) -> u32 {
        self.sample_count
    }

    /// Adds a sample: positions (m), one for each vertex. Returns the XXH3-64 of its bytes.
    ///
    /// # Errors
    /// [`Error::Cache`] when the disk is full; the file then holds what it held.
    ///
    /// # Panics
    /// When there are not as many positions as vertices.
    pub fn append(&mut self, positions: &[Vector]) -> Result<u64> {
        assert_eq!(positions.len(), self.vertex_count as usize, "one position for each vertex");
        self.buffer.clear();
        for position in positions {
            for axis in 0..3 {
                self.buffer.extend((position[axis] as f32).to_le_bytes());
            }
        }
        self.write_sample().map_err(|error| Error::cache(&self.path, "written", &error))?;
        Ok(xxh3_64(&self.buffer))
    }

    /// Forgets the samples from `sample_count` on.
    ///
    /// # Errors
    /// [`Error::Cache`] when the file cannot be written.
    pub fn truncate(&mut self, sample_count: u32) -> Result<()> {
        let end = self.end_of(sample_count);
        let cut = |file: &mut File| {
            write_sample_count(file, sample_count)?;
            file.set_len(end)
        };
        cut(&mut self.file).map_err(|error| Error::cache(&self.path, "written", &error))?;
        self.sample_count = sample_count;
        Ok(())
    }

    /// Returns when the disk holds every sample.
    ///
    /// # Errors
    /// [`Error::Cache`] when it cannot.
    pub fn sync(&self) -> Result<()> {
        self.file.sync_data().map_err(|error| Error::cache(&self.path, "written", &error))
    }

    /// Writes the header, of which less than what is compared may be as it was.
    fn begin_with(&mut self, header: Header) -> Result<()> {
        let written = self.file.rewind().and_then(|()| self.file.write_all(&header.bytes()));
        written.map_err(|error| Error::cache(&self.path, "written", &error))
    }

    fn write_sample(&mut self) -> std::io::Result<()> {
        self.file.seek(SeekFrom::Start(self.end_of(self.sample_count)))?;
        self.file.write_all(&self.buffer)?;
        write_sample_count(&mut self.file, self.sample_count + 1)?;
        self.sample_count += 1;
        Ok(())
    }

    fn end_of(&self, sample_count: u32) -> u64 {
        HEADER_BYTES + 12 * u64::from(self.vertex_count) * u64::from(sample_count)
    }
}

fn write_sample_count(file: &mut File, sample_count: u32) -> std::io::Result<()> {
    file.seek(SeekFrom::Start(SAMPLE_COUNT_AT))?;
    file.write_all(&sample_count.to_le_bytes())
}

/// The first sample of a file, read from behind its header, that has another hash or is not there.
fn first_changed(file: &mut File, vertex_count: u32, hashes: &[u64]) -> Option<usize> {
    let size = 12 * u64::from(vertex_count);
    let mut source = BufReader::new(file);
    let mut sample = Vec::new();
    hashes.iter().position(|&hash| {
        sample.clear();
        let read = (&mut source).take(size).read_to_end(&mut sample);
        read.is_err() || sample.len() as u64 != size || xxh3_64(&sample) != hash
    })
}

/// What stands before the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// Vertices of the cloth.
    pub vertex_count: u32,
    /// The frame of the first sample.
    pub first_frame: i32,
    /// Samples, one a frame.
    pub sample_count: u32,
}

impl Header {
    fn bytes(self) -> [u8; HEADER_BYTES as usize] {
        let mut bytes = [0; HEADER_BYTES as usize];
        bytes[..12].copy_from_slice(MAGIC);
        let fields = [
            1_i32.to_le_bytes(),
            self.vertex_count.to_le_bytes(),
            // Frame numbers are below 2^24, so that they are exact here.
            (self.first_frame as f32).to_le_bytes(),
            1_f32.to_le_bytes(),
            self.sample_count.to_le_bytes(),
        ];
        bytes[12..].copy_from_slice(fields.as_flattened());
        bytes
    }

    /// Reads a header.
    ///
    /// # Errors
    /// Those of the source; invalid data when it is no POINTCACHE2 of version 1 with one sample a frame.
    pub fn read(source: &mut impl Read) -> std::io::Result<Self> {
        let mut bytes = [0; HEADER_BYTES as usize];
        source.read_exact(&mut bytes)?;
        let field = |at: usize| {
            let mut four = [0; 4];
            four.copy_from_slice(&bytes[at..at + 4]);
            four
        };
        let is_ours = &bytes[..12] == MAGIC
            && i32::from_le_bytes(field(12)) == 1
            && field(24) == 1_f32.to_le_bytes();
        if !is_ours {
            let message = "it is no POINTCACHE2 of version 1 with one sample a frame";
            return Err(std::io::Error::new(std::io::ErrorKind::InvalidData, message));
        }
        Ok(Self {
            vertex_count: u32::from_le_bytes(field(16)),
            first_frame: f32::from_le_bytes(field(20)) as i32,
            sample_count: u32::from_le_bytes(field(28)),
        })
    }
}

/// Reads a whole file: its header, and x, y, z (m) of every vertex of every sample.
///
/// # Errors
/// [`Error::Cache`] when it cannot be read, is no POINTCACHE2, or is shorter than its header says.
pub fn read(path: &Path) -> Result<(Header, Vec<f32>)> {
    let refuse = |error| Error::cache(path, "read", &error);
    let mut file = File::open(path).map_err(refuse)?;
    let header = Header::read(&mut file).map_err(refuse)?;
    let numbers = u64::from(header.vertex_count) * u64::from(header.sample_count);
    let wanted = numbers.saturating_mul(12);
    let mut bytes = Vec::new();
    file.take(wanted).read_to_end(&mut bytes).map_err(refuse)?;
    if (bytes.len() as u64) < wanted {
        return Err(refuse(std::io::ErrorKind::UnexpectedEof.into()));
    }
    let number = |four: &[u8]| f32::from_le_bytes([four[0], four[1], four[2], four[3]]);
    Ok((header, bytes.chunks_exact(4).map(number).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn positions(value: f64) -> Vec<Vector> {
        vec![Vector::new(value, 2.0, 3.0), Vector::new(4.0, 5.0, 6.0)]
    }

    #[test]
    fn samples_read_back_as_written_and_the_header_is_the_format() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("flag.pc2");
        let mut writer = Writer::create(&path, 2, -3).expect("there is room");
        writer.append(&positions(0.1)).expect("there is room");
        writer.append(&positions(-0.2)).expect("there is room");
        let (header, numbers) = read(&path).expect("our own file");
        assert_eq!(header, Header { vertex_count: 2, first_frame: -3, sample_count: 2 });
        assert_eq!(numbers, [0.1, 2., 3., 4., 5., 6., -0.2, 2., 3., 4., 5., 6.]);
        let bytes = std::fs::read(&path).expect("it is there");
        assert_eq!(bytes.len(), 32 + 2 * 24);
        assert_eq!(&bytes[..20], b"POINTCACHE2\0\x01\0\0\0\x02\0\0\0");
        assert_eq!(&bytes[20..32], b"\0\0\x40\xc0\0\0\x80\x3f\x02\0\0\0");
    }

    #[test]
    fn data_without_its_count_is_no_sample_and_is_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("flag.pc2");
        let mut writer = Writer::create(&path, 2, 1).expect("there is room");
        let hash = writer.append(&positions(1.0)).expect("there is room");
        drop(writer);
        let mut file = OpenOptions::new().append(true).open(&path).expect("it is there");
        file.write_all(&[9; 17]).expect("half a sample");
        assert_eq!(read(&path).expect("a valid prefix").0.sample_count, 1);
        let mut writer = Writer::resume(&path, 2, 1, &[hash]).expect("the same cloth");
        writer.append(&positions(7.0)).expect("there is room");
        assert_eq!(read(&path).expect("whole").1[6].to_bits(), 7_f32.to_bits());
        assert_eq!(std::fs::metadata(&path).expect("it is there").len(), 32 + 48);
    }

    #[test]
    fn samples_behind_the_checkpoint_are_forgotten() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("flag.pc2");
        let mut writer = Writer::create(&path, 2, 1).expect("there is room");
        let mut append =
            |sample| writer.append(&positions(f64::from(sample))).expect("there is room");
        let hashes: Vec<u64> = (0..5).map(&mut append).collect();
        drop(writer);
        assert_eq!(
            Writer::resume(&path, 2, 1, &hashes[..2]).expect("five are there").sample_count(),
            2
        );
        assert_eq!(std::fs::metadata(&path).expect("it is there").len(), 32 + 48);
    }

    #[test]
    fn another_cloth_or_too_few_samples_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("flag.pc2");
        drop(Writer::create(&path, 2, 1).expect("there is room"));
        for (vertices, first, hashes) in [(3, 1, &[][..]), (2, 2, &[]), (2, 1, &[7])] {
            let error = Writer::resume(&path, vertices, first, hashes).expect_err("another");
            assert_eq!(error.exit_code(), 4);
        }
        std::fs::write(&path, b"POINTCACHE1").expect("there is room");
        assert!(read(&path).is_err());
    }

    /// Every bit: of the header, of samples that are gone on from, and none of those behind them.
    #[test]
    fn a_file_with_a_bit_changed_is_refused_or_mended() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("flag.pc2");
        let mut writer = Writer::create(&path, 2, 1).expect("there is room");
        let mut append = |value| writer.append(&positions(value)).expect("there is room");
        let hashes = [append(1.0), append(2.0)];
        let whole = std::fs::read(&path).expect("it is there");
        append(3.0);
        drop(writer);
        let longer = std::fs::read(&path).expect("it is there");
        for bit in 0..8 * longer.len() {
            let mut bytes = longer.clone();
            bytes[bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&path, bytes).expect("there is room");
            match Writer::resume(&path, 2, 1, &hashes) {
                Ok(_) => assert_eq!(std::fs::read(&path).expect("it is there"), whole, "bit {bit}"),
                Err(error) => assert!(bit / 8 < whole.len(), "bit {bit}: {error}"),
            }
        }
        for length in 0..longer.len() as u64 {
            std::fs::write(&path, &longer[..length as usize]).expect("there is room");
            let resumed = Writer::resume(&path, 2, 1, &hashes);
            assert_eq!(resumed.is_ok(), length as usize >= whole.len(), "cut at {length}");
        }
        let mut bytes = longer;
        bytes[32 + 24] ^= 1;
        std::fs::write(&path, bytes).expect("there is room");
        let error = Writer::resume(&path, 2, 1, &hashes).expect_err("a bit of the second sample");
        assert!(error.to_string().contains("frame 2 is not as the bake wrote it"), "{error}");
    }

    /// Four billion samples of four billion vertices are more bytes than can be counted.
    #[test]
    fn a_header_that_claims_more_than_there_is_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("flag.pc2");
        for (vertex_count, sample_count) in [(u32::MAX, u32::MAX), (1 << 31, 1), (1, 1 << 31)] {
            let mut bytes = Header { vertex_count, first_frame: 1, sample_count }.bytes().to_vec();
            bytes.extend([0; 12]);
            std::fs::write(&path, bytes).expect("there is room");
            let error = read(&path).expect_err("there are 12 bytes");
            assert!(error.to_string().contains("cannot be read"), "{error}");
        }
    }
}
