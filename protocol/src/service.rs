//! Opening a stream's services: one version, one set of limits, a place in it.
//!
//! Separate from the ports because this is where processes that start, die and come back at
//! the same moment meet; all the patience that this needs is here.

use std::fmt::Debug;
use std::time::{Duration, Instant};

use iceoryx2::prelude::{AttributeVerifier, EventId, MessagingPattern, ServiceName};
use iceoryx2::service::Service as _;
use iceoryx2::service::port_factory::{event, publish_subscribe};

use crate::domain::Service;
use crate::error::PortError;
use crate::presence::Membership;
use crate::stream::{MAX_NODES, Spec, Stream};

/// Longest time in which a place held by the dead, or a service half made, must come free.
pub(crate) const TAKEOVER: Duration = Duration::from_secs(3);

/// Time between two attempts.
const RETRY: Duration = Duration::from_millis(20);

/// Attribute under which the version is written.
const VERSION_KEY: &str = "ampco.protocol";

/// The messages of a stream, opened.
pub(crate) type Messages<S> =
    publish_subscribe::PortFactory<Service, [<S as Stream>::Item], <S as Stream>::Header>;

/// Opens or creates the messages of a stream.
pub(crate) fn messages<S: Stream>(member: &Membership) -> Result<Messages<S>, PortError> {
    let spec = S::SPEC;
    let (name, version) = identity(member, &spec)?;
    persist(member, &spec, MessagingPattern::PublishSubscribe, || {
        member
            .handle()
            .service_builder(&name)
            .publish_subscribe::<[S::Item]>()
            .user_header::<S::Header>()
            .enable_safe_overflow(spec.overflow)
            .history_size(spec.history)
            .subscriber_max_buffer_size(spec.buffer)
            .subscriber_max_borrowed_samples(spec.borrowed)
            .max_publishers(spec.publishers)
            .max_subscribers(spec.subscribers)
            .max_nodes(MAX_NODES)
            .open_or_create_with_attributes(&version)
    })
}

/// Opens or creates the event of a stream: rung after each message, and when a writer comes or goes.
pub(crate) fn events(
    member: &Membership,
    spec: &Spec,
) -> Result<event::PortFactory<Service>, PortError> {
    let (name, version) = identity(member, spec)?;
    persist(member, spec, MessagingPattern::Event, || {
        member
            .handle()
            .service_builder(&name)
            .event()
            .max_notifiers(spec.publishers)
            .max_listeners(spec.subscribers)
            .max_nodes(MAX_NODES)
            .event_id_max_value(3)
            .notifier_created_event(EventId::new(1))
            .notifier_dropped_event(EventId::new(2))
            .notifier_dead_event(EventId::new(3))
            .open_or_create_with_attributes(&version)
    })
}

/// Takes one of `limit` places, waiting until the dead have given theirs back.
pub(crate) fn place<P, E: Debug>(
    member: &Membership,
    spec: &Spec,
    side: &'static str,
    limit: usize,
    mut create: impl FnMut() -> Result<P, E>,
) -> Result<P, PortError> {
    let deadline = Instant::now() + TAKEOVER;
    loop {
        let error = match create() {
            Ok(port) => return Ok(port),
            Err(error) => format!("{error:?}"),
        };
        let full = error.starts_with("ExceedsMaxSupported");
        if Instant::now() >= deadline || !full {
            return Err(if full {
                taken(spec, side, limit)
            } else {
                refused(spec, "creating a port", error)
            });
        }
        member.clean();
        std::thread::sleep(RETRY);
    }
}

/// Repeats `open` while others create, leave or are cleaned up.
fn persist<F, E: Debug>(
    member: &Membership,
    spec: &Spec,
    pattern: MessagingPattern,
    mut open: impl FnMut() -> Result<F, E>,
) -> Result<F, PortError> {
    let deadline = Instant::now() + TAKEOVER;
    loop {
        let error = match open() {
            Ok(factory) => return Ok(factory),
            Err(error) => format!("{error:?}"),
        };
        let ours = member.domain().version();
        if let Some(theirs) = version_in_use(member, spec, pattern)
            && theirs != ours.to_string()
        {
            let stream = spec.name;
            return Err(PortError::Version {
                stream,
                theirs,
                ours,
            });
        }
        if Instant::now() >= deadline {
            return Err(refused(spec, "opening", error));
        }
        member.clean();
        std::thread::sleep(RETRY);
    }
}

fn identity(
    member: &Membership,
    spec: &Spec,
) -> Result<(ServiceName, AttributeVerifier), PortError> {
    let failed = |error: String| refused(spec, "naming", error);
    let name = ServiceName::new(spec.name).map_err(|error| failed(format!("{error:?}")))?;
    let key = VERSION_KEY
        .try_into()
        .map_err(|error| failed(format!("{error:?}")))?;
    let value = member.domain().version().to_string();
    let value = value
        .as_str()
        .try_into()
        .map_err(|error| failed(format!("{error:?}")))?;
    let version = AttributeVerifier::new()
        .require(&key, &value)
        .map_err(|error| failed(format!("{error:?}")))?;
    Ok((name, version))
}

fn version_in_use(member: &Membership, spec: &Spec, pattern: MessagingPattern) -> Option<String> {
    let name = ServiceName::new(spec.name).ok()?;
    let details = Service::details(&name, member.handle().config(), pattern).ok()??;
    let key = VERSION_KEY.try_into().ok()?;
    let value = details.static_details.attributes().key_value(&key, 0)?;
    Some(value.to_string())
}

fn taken(spec: &Spec, side: &'static str, limit: usize) -> PortError {
    let remedy = if limit == 1 {
        "a second process of this role is running in the same run; stop one of them"
    } else {
        "start fewer actors or monitors"
    };
    PortError::Taken {
        stream: spec.name,
        side,
        limit,
        remedy,
    }
}

fn refused(spec: &Spec, action: &'static str, cause: String) -> PortError {
    PortError::System {
        stream: spec.name,
        action,
        cause,
    }
}
