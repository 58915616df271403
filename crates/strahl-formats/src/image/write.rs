//! Writes files atomically: a file is complete or does not exist.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::{ImageError, ImageFormat, Picture, WriteOptions};

/// Writes the picture in the format the file's extension asks for.
///
/// The picture is written to a temporary file in the same folder, which is then renamed: under the file's name there is either
/// the complete picture or the previous file, whatever happens. If writing fails, the temporary file is removed. A symbolic
/// link is followed. Devices and pipes, which can't be replaced, are written directly.
pub fn write_picture(
    path: impl AsRef<Path>,
    picture: &Picture<'_>,
    options: &WriteOptions,
) -> Result<(), ImageError> {
    let path = path.as_ref();
    let format = ImageFormat::from_path(path)?;
    format.check(picture)?;
    let encode = format.info().encode;
    write_atomically(path, |writer| encode(writer, picture, options))
}

/// Writes the picture to a stream, for instance the standard output.
///
/// After an error the stream may contain the picture's beginning.
pub fn encode_picture(
    writer: &mut dyn Write,
    format: ImageFormat,
    picture: &Picture<'_>,
    options: &WriteOptions,
) -> Result<(), ImageError> {
    format.check(picture)?;
    (format.info().encode)(writer, picture, options)
        .and_then(|()| writer.flush())
        .map_err(|source| ImageError::Write {
            target: "the picture".to_owned(),
            source,
        })
}

/// Writes any other file in the same way.
pub fn write_bytes(path: impl AsRef<Path>, bytes: &[u8]) -> Result<(), ImageError> {
    write_atomically(path.as_ref(), |writer| writer.write_all(bytes))
}

/// Writes any other file in the same way, by a function that gets the stream; if it fails, no file is left.
pub fn write_file(
    path: impl AsRef<Path>,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), ImageError> {
    write_atomically(path.as_ref(), fill)
}

/// Lets `fill` write a file, which takes its place only when it is complete.
fn write_atomically(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), ImageError> {
    let failed = |source| ImageError::writing(path, source);
    let mut permissions = None;
    let mut target = path.to_owned();
    if let Ok(existing) = fs::metadata(path) {
        if existing.is_dir() {
            return Err(ImageError::IsFolder {
                path: path.to_owned(),
            });
        }
        if !existing.is_file() {
            let device = OpenOptions::new().write(true).open(path).map_err(failed)?;
            return fill_file(&device, fill).map_err(failed);
        }
        // Renaming replaces a file even where its protection says that nobody should.
        if existing.permissions().readonly() {
            let reason = io::Error::new(io::ErrorKind::PermissionDenied, "it is write-protected");
            return Err(failed(reason));
        }
        permissions = Some(existing.permissions());
        target = fs::canonicalize(path).map_err(failed)?;
    }

    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let temporary = temporary_file(folder).map_err(|source| match source.kind() {
        io::ErrorKind::NotFound => ImageError::FolderMissing {
            path: path.to_owned(),
            folder: folder.to_owned(),
        },
        _ => failed(source),
    })?;
    let finish = || -> io::Result<()> {
        fill_file(temporary.as_file(), fill)?;
        if let Some(permissions) = permissions {
            temporary.as_file().set_permissions(permissions)?;
        }
        // Network file systems report a full disk only at this point.
        temporary.as_file().sync_all()
    };
    finish().map_err(failed)?;
    temporary
        .persist(&target)
        .map_err(|error| failed(error.error))?;
    Ok(())
}

/// A file with a name of its own, removed when dropped.
fn temporary_file(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".strahl-").suffix(".tmp");
    // Pictures get the usual permissions, while temporary files would be readable by the owner only.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

fn fill_file(file: &File, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut writer = BufWriter::new(file);
    fill(&mut writer)?;
    writer.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_failed_write_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let fail = |writer: &mut dyn Write| {
            writer.write_all(&[7; 100_000])?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        };

        let error = write_atomically(&path, fail).unwrap_err();
        assert!(matches!(error, ImageError::DiskFull { .. }), "{error}");
        assert!(names(folder.path()).is_empty());

        fs::write(&path, "before").unwrap();
        write_atomically(&path, fail).unwrap_err();
        assert_eq!(fs::read(&path).unwrap(), b"before");
        assert_eq!(names(folder.path()), ["picture.png"]);

        write_atomically(&path, |writer| writer.write_all(b"after")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"after");
        assert_eq!(names(folder.path()), ["picture.png"]);
    }

    #[test]
    fn a_panicking_encoder_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        let result = std::panic::catch_unwind(|| write_atomically(&path, |_| panic!("on purpose")));
        assert!(result.is_err());
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn places_that_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let write = |path: &Path| write_atomically(path, |writer| writer.write_all(b"x"));

        let error = write(&folder.path().join("absent/picture.png")).unwrap_err();
        assert!(matches!(error, ImageError::FolderMissing { .. }), "{error}");
        let error = write(folder.path()).unwrap_err();
        assert!(matches!(error, ImageError::IsFolder { .. }), "{error}");

        let file = folder.path().join("file");
        fs::write(&file, "before").unwrap();
        let error = write(&file.join("picture.png")).unwrap_err();
        assert!(matches!(error, ImageError::NotWritable { .. }), "{error}");

        let mut permissions = fs::metadata(&file).unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&file, permissions).unwrap();
        let error = write(&file).unwrap_err();
        assert!(matches!(error, ImageError::NotWritable { .. }), "{error}");
        assert!(error.to_string().contains("write-protected"), "{error}");
        assert_eq!(fs::read(&file).unwrap(), b"before");
        assert_eq!(names(folder.path()), ["file"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_protected_folder_is_reported() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("picture.png");
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o555)).unwrap();
        let result = write_atomically(&path, |writer| writer.write_all(b"x"));
        fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o755)).unwrap();
        // The superuser may write everywhere; everybody else is told.
        match result {
            Ok(()) => assert_eq!(names(folder.path()), ["picture.png"]),
            Err(error) => {
                assert!(matches!(error, ImageError::NotWritable { .. }), "{error}");
                assert!(names(folder.path()).is_empty());
            }
        }
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_permissions_kept_devices_written() {
        use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "before").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&file, &link).unwrap();
        write_atomically(&link, |writer| writer.write_all(b"after")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"after");
        assert_eq!(
            fs::metadata(&file).unwrap().permissions().mode() & 0o777,
            0o640
        );

        let null = Path::new("/dev/null");
        write_atomically(null, |writer| writer.write_all(b"x")).unwrap();
        assert!(fs::metadata(null).unwrap().file_type().is_char_device());
    }

    #[cfg(unix)]
    #[test]
    fn new_files_have_the_usual_permissions() {
        let folder = tempfile::tempdir().unwrap();
        let (ours, usual) = (folder.path().join("ours"), folder.path().join("usual"));
        write_atomically(&ours, |writer| writer.write_all(b"x")).unwrap();
        fs::write(&usual, "x").unwrap();
        let permissions = |path| fs::metadata(path).unwrap().permissions();
        assert_eq!(permissions(ours), permissions(usual));
    }
}
