//! Who may speak: the certificates of a run, and the file that another machine is given.
//!
//! When a run begins to listen an authority of its own is made; it signs one certificate for the gate and one for
//! hosts, and its key is thrown away: nobody can sign a third. A gate and a host know each other by that authority
//! alone, whatever their addresses are. What a host is given lets it join and lets nobody pass for the gate.

use std::fs::{self, DirBuilder, OpenOptions, Permissions};
use std::io::{self, Write};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rcgen::{
    BasicConstraints, CertificateParams, DnType, ExtendedKeyUsagePurpose, IsCa, Issuer, KeyPair,
    KeyUsagePurpose,
};
use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use rustls::server::WebPkiClientVerifier;
use rustls::version::TLS13;
use rustls::{ClientConfig, RootCertStore, ServerConfig};

/// The name in the gate's certificate: hosts look for it, whatever address they call.
pub(crate) const GATE: &str = "gate.ampco";
/// What both ends speak within TLS.
const HTTP2: &[u8] = b"h2";
/// Name of the folder in that of the run.
const FOLDER: &str = "join";
/// Name of the gate's own file.
const OWN: &str = "gate.pem";

/// First line of the file that is carried away, before the run's name.
const FIRST: &str = "ampco join file of run ";

/// Why there are no passes.
#[derive(Debug, thiserror::Error)]
pub enum PassError {
    /// A file cannot be read or written.
    #[error("{}", path.display())]
    Files {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        #[source]
        source: io::Error,
    },
    /// A file does not hold what it should.
    #[error("{} is no join file: {problem}; copy it again from the join/ folder of the run", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
    /// Certificates could not be made.
    #[error("making the certificates of the run: {0}")]
    Making(String),
}

/// The passes of a run, on the learner's machine.
#[derive(Debug)]
pub struct Passes {
    own: Pass,
    /// The file for other machines.
    pub carried: PathBuf,
}

/// One end's certificate and key, and the authority by which it knows the other.
#[derive(Debug)]
pub struct Pass {
    /// Name of the run, as the file says it; empty in the gate's own.
    pub run: String,
    authority: CertificateDer<'static>,
    certificate: CertificateDer<'static>,
    key: PrivateKeyDer<'static>,
}

impl Passes {
    /// The passes in the folder of a run, made where there are none: a run that listens again is known by the files that
    /// were carried away before.
    ///
    /// # Errors
    /// Files that cannot be read, written or used.
    pub fn of(folder: &Path, run: &str) -> Result<Self, PassError> {
        let folder = folder.join(FOLDER);
        let (own, carried) = (folder.join(OWN), folder.join(format!("{run}.join")));
        if !own.is_file() || !carried.is_file() {
            make(&folder, &own, &carried, run)?;
        }
        // Somebody may have copied the folder about.
        for (path, mode) in [(&folder, 0o700), (&own, 0o600), (&carried, 0o600)] {
            fs::set_permissions(path, Permissions::from_mode(mode))
                .map_err(|source| files(path, source))?;
        }
        Ok(Self {
            own: Pass::read(&own)?,
            carried,
        })
    }

    /// How the gate speaks TLS: with whoever shows a pass of this run.
    ///
    /// # Errors
    /// Certificates that cannot be used.
    pub fn server(&self) -> Result<Arc<ServerConfig>, PassError> {
        let verifier = WebPkiClientVerifier::builder_with_provider(
            Arc::new(self.own.roots()?),
            Arc::new(rustls::crypto::ring::default_provider()),
        )
        .build()
        .map_err(making)?;
        let provider = Arc::new(rustls::crypto::ring::default_provider());
        let mut config = ServerConfig::builder_with_provider(provider)
            .with_protocol_versions(&[&TLS13])
            .map_err(making)?
            .with_client_cert_verifier(verifier)
            .with_single_cert(vec![self.own.certificate.clone()], self.own.key.clone_key())
            .map_err(making)?;
        config.alpn_protocols = vec![HTTP2.to_vec()];
        // Resuming would let a peer in without looking at its pass again, and is of no use to connections that last.
        config.send_tls13_tickets = 0;
        Ok(Arc::new(config))
    }
}

impl Pass {
    /// The pass in a file.
    ///
    /// # Errors
    /// A file that cannot be read, or holds something else.
    pub fn read(path: &Path) -> Result<Self, PassError> {
        let text = fs::read(path).map_err(|source| files(path, source))?;
        let content = |problem: String| PassError::Content {
            path: path.to_owned(),
            problem,
        };
        let certificates = CertificateDer::pem_slice_iter(&text)
            .collect::<Result<Vec<_>, _>>()
            .map_err(|error| content(error.to_string()))?;
        let key =
            PrivateKeyDer::from_pem_slice(&text).map_err(|error| content(error.to_string()))?;
        let [authority, certificate] = certificates
            .try_into()
            .map_err(|found: Vec<_>| content(format!("{} certificates, not 2", found.len())))?;
        let first = text.split(|byte| *byte == b'\n').next().unwrap_or_default();
        let run = first.strip_prefix(FIRST.as_bytes()).unwrap_or_default();
        Ok(Self {
            run: String::from_utf8_lossy(run).into_owned(),
            authority,
            certificate,
            key,
        })
    }

    /// How a host speaks TLS: with the gate of its run alone.
    ///
    /// # Errors
    /// Certificates that cannot be used.
    pub fn client(&self) -> Result<Arc<ClientConfig>, PassError> {
        let provider = Arc::new(rustls::crypto::ring::default_provider());
        let mut config = ClientConfig::builder_with_provider(provider)
            .with_protocol_versions(&[&TLS13])
            .map_err(making)?
            .with_root_certificates(self.roots()?)
            .with_client_auth_cert(vec![self.certificate.clone()], self.key.clone_key())
            .map_err(making)?;
        config.alpn_protocols = vec![HTTP2.to_vec()];
        Ok(Arc::new(config))
    }

    fn roots(&self) -> Result<RootCertStore, PassError> {
        let mut roots = RootCertStore::empty();
        roots.add(self.authority.clone()).map_err(making)?;
        Ok(roots)
    }
}

fn make(folder: &Path, own: &Path, carried: &Path, run: &str) -> Result<(), PassError> {
    let mut builder = DirBuilder::new();
    match builder.mode(0o700).create(folder) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
            return Err(files(folder, error));
        }
        _ => {}
    }
    let mut params = named(&format!("ampco run {run}"), &[])?;
    params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
    params.key_usages = vec![KeyUsagePurpose::KeyCertSign];
    let key = KeyPair::generate().map_err(making)?;
    let authority = params.self_signed(&key).map_err(making)?.pem();
    let issuer = Issuer::new(params, key);
    let signed = |name: &str, names: &[&str], purpose| {
        let mut params = named(name, names)?;
        params.extended_key_usages = vec![purpose];
        params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
        let key = KeyPair::generate().map_err(making)?;
        let certificate = params.signed_by(&key, &issuer).map_err(making)?;
        Ok::<_, PassError>(format!("{}{}", certificate.pem(), key.serialize_pem()))
    };
    let gate = signed("gate", &[GATE], ExtendedKeyUsagePurpose::ServerAuth)?;
    let host = signed("host", &["host.ampco"], ExtendedKeyUsagePurpose::ClientAuth)?;
    let words = format!(
        "{FIRST}{run}\n\
         Whoever has this file may send rollouts to it: keep it private. On another machine:\n\
         ampco join HOST:PORT --file {run}.join\n"
    );
    write(own, &format!("{authority}{gate}"))?;
    // Last: with it the passes are complete.
    write(carried, &format!("{words}{authority}{host}"))
}

fn named(name: &str, names: &[&str]) -> Result<CertificateParams, PassError> {
    let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
    let mut params = CertificateParams::new(names).map_err(making)?;
    params.distinguished_name.push(DnType::CommonName, name);
    Ok(params)
}

/// Writes a file that nobody else may read, whole or not at all.
fn write(path: &Path, text: &str) -> Result<(), PassError> {
    let aside = path.with_extension("new");
    let written = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(true)
        .mode(0o600)
        .open(&aside)
        .and_then(|mut file| file.write_all(text.as_bytes()))
        .and_then(|()| fs::rename(&aside, path));
    written.map_err(|source| files(path, source))
}

fn files(path: &Path, source: io::Error) -> PassError {
    let path = path.to_owned();
    PassError::Files { path, source }
}

fn making(error: impl std::fmt::Display) -> PassError {
    PassError::Making(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::MetadataExt;

    #[test]
    fn passes_are_private_and_stay_the_same() {
        let run = tempfile::tempdir().unwrap();
        let passes = Passes::of(run.path(), "walk").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().mode() & 0o777;
        let folder = run.path().join("join");
        assert_eq!(mode(&folder), 0o700);
        assert_eq!(passes.carried, folder.join("walk.join"));
        for entry in fs::read_dir(&folder).unwrap() {
            assert_eq!(mode(&entry.unwrap().path()), 0o600);
        }
        let before = fs::read(&passes.carried).unwrap();
        fs::set_permissions(&passes.carried, Permissions::from_mode(0o644)).unwrap();
        let again = Passes::of(run.path(), "walk").unwrap();
        assert_eq!(fs::read(&again.carried).unwrap(), before);
        assert_eq!(mode(&again.carried), 0o600);
        again.server().unwrap();
        let pass = Pass::read(&again.carried).unwrap();
        assert_eq!(pass.run, "walk");
        pass.client().unwrap();
    }

    #[test]
    fn the_authoritys_key_and_the_gates_are_not_carried_away() {
        let run = tempfile::tempdir().unwrap();
        let passes = Passes::of(run.path(), "walk").unwrap();
        let carried = fs::read_to_string(&passes.carried).unwrap();
        let own = fs::read_to_string(run.path().join("join/gate.pem")).unwrap();
        let keys = |text: &str| -> Vec<String> {
            let parts = text.split("-----BEGIN PRIVATE KEY-----").skip(1);
            parts.map(str::to_owned).collect()
        };
        assert_eq!((keys(&carried).len(), keys(&own).len()), (1, 1));
        assert_ne!(keys(&carried), keys(&own));
    }

    #[test]
    fn another_file_is_refused_with_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.join");
        fs::write(&path, "no pass").unwrap();
        let said = Pass::read(&path).unwrap_err().to_string();
        assert!(
            said.contains("is no join file") && said.contains("copy it again"),
            "{said}"
        );
        let missing = Pass::read(&folder.path().join("none")).unwrap_err();
        assert!(missing.to_string().ends_with("none"), "{missing}");
    }
}
