//! Writing a file so that it is complete or not there at all.

use crate::ImageError;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes a file through a temporary one beside it: filled, synced to the disk, renamed.
///
/// A failed write, as on a full disk, leaves a previous file as it was and removes the temporary one; a killed process can
/// leave a `.lesk-*.tmp` behind, never a half-written file under the name. A symbolic link stays one: its target is
/// replaced. Permissions of a previous file are kept, and one that is read-only is refused. A name that stands for a device
/// or a pipe is written to directly. A limit on file sizes (RLIMIT_FSIZE) comes as an error only where the process ignores
/// SIGXFSZ, as Python does; otherwise the system ends the process, and the previous file still is as it was.
///
/// `size` is how many bytes are to come, for the error message.
///
/// # Errors
/// [`ImageError::Write`] with the path, the bytes written and what the system said.
pub fn atomic_write(
    path: impl AsRef<Path>,
    size: Option<u64>,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    let mut written = 0;
    write(path, &mut written, fill).map_err(|source| ImageError::Write {
        path: path.to_path_buf(),
        written,
        size,
        source,
    })
}

/// Writes bytes with [`atomic_write`].
///
/// # Errors
/// As [`atomic_write`].
pub fn write_bytes(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), ImageError> {
    atomic_write(path, Some(bytes.len() as u64), |out| out.write_all(bytes))
}

fn write(path: &Path, written: &mut u64, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let previous = fs::metadata(&target).ok();
    if previous.as_ref().is_some_and(|m| m.is_dir()) {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
    }
    if previous.is_some() {
        // refuses a file that may not be written, which a rename would replace all the same
        let file = OpenOptions::new().write(true).open(&target)?;
        if !file.metadata()?.is_file() {
            return fill_file(file, written, fill).map(drop);
        }
    }
    let mut temporary = Temporary::beside(&target)?;
    let file = temporary.file.take().expect("a new temporary file is open");
    let file = fill_file(file, written, fill)?;
    if let Some(previous) = previous {
        file.set_permissions(previous.permissions())?;
    }
    file.sync_all()?;
    drop(file);
    fs::rename(&temporary.path, &target)?;
    temporary.renamed = true;
    sync_folder(&target);
    Ok(())
}

/// Lets `fill` write through a buffer, and counts what reaches the file.
fn fill_file(file: File, written: &mut u64, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<File> {
    let mut out = BufWriter::with_capacity(1 << 16, Counted { file, written });
    let result = fill(&mut out).and_then(|()| out.flush());
    // into_parts does not try to write the rest again, as a drop would
    let (counted, _) = out.into_parts();
    result.map(|()| counted.file)
}

struct Counted<'a> {
    file: File,
    written: &'a mut u64,
}

impl Write for Counted<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = self.file.write(bytes)?;
        *self.written += n as u64;
        Ok(n)
    }
    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// A file that is removed again unless it was renamed.
struct Temporary {
    path: PathBuf,
    file: Option<File>,
    renamed: bool,
}

impl Temporary {
    fn beside(target: &Path) -> io::Result<Temporary> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let folder = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut tries = 0;
        loop {
            let number = COUNT.fetch_add(1, Ordering::Relaxed);
            let path = folder.join(format!(".lesk-{}-{number}.tmp", std::process::id()));
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok(Temporary { path, file: Some(file), renamed: false }),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists && tries < 100 => tries += 1,
                Err(error) => return Err(error),
            }
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.renamed {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Brings the new name itself to the disk; not every file system can, and the file is complete either way.
fn sync_folder(target: &Path) {
    if let Some(folder) = target.parent().filter(|_| cfg!(unix)) {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let _ = File::open(folder).and_then(|f| f.sync_all());
    }
}
